#include "render/passes/motion_camera_pass.h"

#include "render/frame_scene.h"
#include "render/gpu/shader_library.h"

#include <algorithm>

namespace limn {

Result<MotionCameraPass> create_motion_camera_pass(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "motion_camera.frag"});
    if (!program) {
        return program.error();
    }
    return MotionCameraPass{*program};
}

TextureId blur_camera_motion(
    FrameGraph& graph, const MotionCameraPass& pass, const MotionBlur& settings,
    const FrameScene& scene, const Gbuffer& gbuffer, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const TextureId blurred = graph.create(
        {.name = "motion blur", .format = spec.format, .width = spec.width, .height = spec.height});
    graph.add_pass(
        "motion blur", {radiance, gbuffer.depth}, {discarded(blurred)},
        [&program = *pass.program, &scene, settings, radiance,
         depth = gbuffer.depth](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            bind_view(context.device(), scene);
            program.set("half_exposure", half_exposure(settings));
            program.set("longest", 0.5f * settings.longest * static_cast<float>(context.size().y));
            program.set("samples", std::clamp(settings.samples, 4, 64));
            context.bind_texture(0, radiance);
            context.bind_texture(1, depth);
            context.device().draw_fullscreen();
        });
    return blurred;
}

}  // namespace limn
