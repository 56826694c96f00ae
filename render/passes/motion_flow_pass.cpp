#include "render/passes/motion_flow_pass.h"

#include "render/gpu/shader_library.h"
#include "render/material_pool.h"

namespace limn {
namespace {

constexpr int kSteps = 4;          // each half as far as the one before
constexpr float kTrailing = 1.0f;  // first step along the field, in halves of it
constexpr float kLeading = 0.25f;  // the same against it

TextureId draw_field(
    FrameGraph& graph, MotionFlowPass& pass, const MotionBlur& settings, const FrameScene& scene,
    const Gbuffer& gbuffer) {
    const TextureSpec spec = graph.spec(gbuffer.depth);
    const TextureId field = graph.create(
        {.name = "motion blur.flow",
         .format = GL_RG16F,
         .width = spec.width,
         .height = spec.height});
    graph.add_pass(
        "motion blur, flow", {depth_tested(gbuffer.depth)}, {cleared(field)},
        [&pass, &scene, settings](PassContext& context) {
            bind_view(context.device(), scene);
            draw_motions(
                context.device(), scene, pass.field, {.depth = {.write = false, .func = GL_EQUAL}},
                [&](const gpu::Program& program) {
                    program.set("exposure", 2.0f * half_exposure(settings));
                    program.set("longest", settings.longest * static_cast<float>(context.size().y));
                });
        });
    return field;
}

TextureId warp(
    FrameGraph& graph, const gpu::Program& program, TextureId picture, TextureId field,
    float scale) {
    const TextureSpec spec = graph.spec(picture);
    const TextureId mixed = graph.create(
        {.name = "motion blur", .format = spec.format, .width = spec.width, .height = spec.height});
    graph.add_pass(
        "motion blur", {picture, field}, {discarded(mixed)},
        [&program, picture, field, scale](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            program.set("scale", scale);
            context.bind_texture(0, picture);
            context.bind_texture(1, field);
            context.device().draw_fullscreen();
        });
    return mixed;
}

}  // namespace

Result<MotionFlowPass> create_motion_flow_pass(gpu::Device& device) {
    MotionFlowPass pass = {SurfacePrograms(device, "motion_flow.vert", "motion_flow_field.frag")};
    const Status plain = pass.field.load(kVelocity, 0, {});
    if (!plain) {
        return plain.error();
    }
    const Result<const gpu::Program*> made =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "motion_flow.frag"});
    if (!made) {
        return made.error();
    }
    pass.warp = *made;
    return pass;
}

TextureId blur_along_flow(
    FrameGraph& graph, MotionFlowPass& pass, const MotionBlur& settings, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance) {
    const TextureId field = draw_field(graph, pass, settings, scene, gbuffer);
    float step = 0.5f;
    for (int i = 0; i < kSteps; ++i) {
        radiance = warp(graph, *pass.warp, radiance, field, step * kTrailing);
        radiance = warp(graph, *pass.warp, radiance, field, -step * kLeading);
        step *= 0.5f;
    }
    return radiance;
}

}  // namespace limn
