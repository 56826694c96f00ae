#include "render/passes/motion_stretch_pass.h"

#include "render/gpu/shader_library.h"
#include "render/material_pool.h"

#include <algorithm>

namespace limn {
namespace {

void copy_picture(
    FrameGraph& graph, std::string_view name, const gpu::Program& program, TextureId from,
    TextureId to) {
    graph.add_pass(name, {from}, {discarded(to)}, [&program, from](PassContext& context) {
        context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
        program.set("weight", 1.0f);
        context.bind_texture(0, from);
        context.device().draw_fullscreen();
    });
}

}  // namespace

Result<MotionStretchPass> create_motion_stretch_pass(gpu::Device& device) {
    MotionStretchPass pass = {
        SurfacePrograms(device, "motion_stretch.vert", "motion_stretch.frag")};
    const Status plain = pass.hull.load(kVelocity, 0, {});
    if (!plain) {
        return plain.error();
    }
    const Result<const gpu::Program*> copy =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "accumulate.frag"});
    if (!copy) {
        return copy.error();
    }
    pass.copy = *copy;
    return pass;
}

TextureId stretch_motion(
    FrameGraph& graph, MotionStretchPass& pass, const MotionBlur& settings, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const gpu::TextureDesc kept = {
        .format = spec.format, .width = spec.width, .height = spec.height};
    if (!pass.before || !(pass.before.desc() == kept)) {
        pass.before = gpu::Texture("picture before", kept);
        pass.any = false;
    }
    const TextureId history = graph.import("motion blur.before", pass.before);
    if (!pass.any || !scene.since_last) {
        copy_picture(graph, "motion blur, first", *pass.copy, radiance, history);
    }

    const TextureId layer_depth = graph.create(
        {.name = "motion blur.depth",
         .format = GL_DEPTH_COMPONENT32F,
         .width = spec.width,
         .height = spec.height});
    const TextureId blurred = graph.create(
        {.name = "motion blur", .format = spec.format, .width = spec.width, .height = spec.height});
    copy_picture(graph, "motion blur, copy", *pass.copy, radiance, blurred);
    graph.add_pass(
        "motion blur", {radiance, history, gbuffer.depth}, {blurred, cleared(layer_depth)},
        [&pass, &scene, settings, radiance, history, depth = gbuffer.depth](PassContext& context) {
            bind_view(context.device(), scene);
            context.bind_texture(0, radiance);
            context.bind_texture(1, history);
            context.bind_texture(2, depth);
            draw_motions(context.device(), scene, pass.hull, {}, [&](const gpu::Program& program) {
                program.set("samples", std::clamp(settings.samples, 2, 64));
                program.set("exposure", 2.0f * half_exposure(settings));
                program.set("longest", settings.longest * static_cast<float>(context.size().y));
                program.set("with_camera", settings.with_camera ? 1 : 0);
            });
        });
    copy_picture(graph, "motion blur, keep", *pass.copy, radiance, history);
    pass.any = true;
    return blurred;
}

void forget_motion(MotionStretchPass& pass) {
    pass.any = false;
}

}  // namespace limn
