#include "render/passes/probe_pass.h"

#include "render/frame_scene.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

namespace limn {

Result<ProbePass> create_probe_pass(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "probe_face.frag"});
    if (!program) {
        return program.error();
    }
    return ProbePass{*program};
}

void keep_probe_face(
    FrameGraph& graph, const ProbePass& pass, TextureId radiance, const gpu::Texture& cube,
    int face) {
    const TextureId target = graph.import("probe cube", cube);
    graph.add_pass(
        "probe face", {radiance}, {target_level(discarded(target), 0, face)},
        [&pass, radiance](PassContext& context) {
            context.device().use(gpu::Pipeline{pass.program, gpu::kFullscreenState});
            context.bind_texture(kGbufferUnit, radiance);
            context.device().draw_fullscreen();
        });
}

}  // namespace limn
