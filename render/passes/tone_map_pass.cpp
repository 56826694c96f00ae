#include "render/passes/tone_map_pass.h"

#include "render/gpu/shader_library.h"

#include <string>

namespace limn {

Result<ToneMapPass> create_tone_map_pass(gpu::Device& device) {
    ToneMapPass pass;
    for (int curve = 0; curve < 3; ++curve) {
        const Result<const gpu::Program*> program = device.shaders().load(
            {.vertex = "fullscreen.vert",
             .fragment = "tone_map.frag",
             .defines = {{"TONE_CURVE", std::to_string(curve)}}});
        if (!program) {
            return program.error();
        }
        pass.programs[curve] = *program;
    }
    return pass;
}

TextureId
tone_map(FrameGraph& graph, const ToneMapPass& pass, const Exposure& exposure, TextureId radiance) {
    const TextureSpec source = graph.spec(radiance);
    const TextureId display = graph.create(
        {.name = "display", .format = GL_RGBA8, .width = source.width, .height = source.height});
    graph.add_pass(
        "tone map",
        {radiance},
        {discarded(display)},
        [&pass, exposure, radiance](PassContext& context) {
            const gpu::Program& program = *pass.programs[static_cast<int>(exposure.curve)];
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("exposure", std::exp2(exposure.ev));
            context.bind_texture(0, radiance);
            context.device().draw_fullscreen();
        });
    return display;
}

}  // namespace limn
