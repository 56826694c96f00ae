#include "render/passes/gbuffer_pass.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

namespace limn {
namespace {

/// Over what no surface covers; nothing while the camera stands still.
void draw_sky_velocity(
    FrameGraph& graph, const GbufferPass& pass, const FrameScene& scene, const Gbuffer& gbuffer) {
    if (scene.view.previous_from_world == scene.view.steady_from_world) {
        return;
    }
    graph.add_pass(
        "gbuffer, sky velocity", {depth_tested(gbuffer.depth)}, {gbuffer.velocity},
        [&pass, &scene](PassContext& context) {
            gpu::PipelineState state = gpu::kFullscreenState;
            state.depth = {.test = true, .write = false, .func = GL_EQUAL};
            context.device().use(gpu::Pipeline{pass.sky_velocity, state});
            bind_view(context.device(), scene);
            context.device().draw_fullscreen();
        });
}

}  // namespace

Result<GbufferPass> create_gbuffer_pass(gpu::Device& device) {
    GbufferPass pass = {SurfacePrograms(device, "mesh.vert", "gbuffer.frag"), nullptr};
    const Status plain = pass.programs.load(0, 0, {});
    if (!plain) {
        return plain.error();
    }
    const Result<const gpu::Program*> sky =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "sky_velocity.frag"});
    if (!sky) {
        return sky.error();
    }
    pass.sky_velocity = *sky;
    return pass;
}

Gbuffer draw_gbuffer(FrameGraph& graph, GbufferPass& pass, const FrameScene& scene, bool velocity) {
    const int width = scene.view.width;
    const int height = scene.view.height;
    Gbuffer g;
    g.surface = graph.create(
        {.name = "gbuffer.surface", .format = GL_RGBA32UI, .width = width, .height = height});
    g.depth = graph.create(
        {.name = "gbuffer.depth",
         .format = static_cast<GLenum>(
             needs_stencil(scene) ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F),
         .width = width,
         .height = height});
    const auto draw = [&pass, &scene, velocity](PassContext& context) {
        bind_view(context.device(), scene);
        const bool clipped = is_clipped(scene);
        draw_runs(
            context.device(), scene, scene.instances.opaque, pass.programs,
            velocity ? kVelocity : 0u, clipped ? 1 : 0,
            clipped ? std::vector<gpu::ShaderDefine>{{"CLIPPED"}}
                    : std::vector<gpu::ShaderDefine>{},
            {.clip = clipped});
    };
    if (velocity) {
        g.velocity = graph.create(
            {.name = "gbuffer.velocity",
             .format = scene.velocity_format,
             .width = width,
             .height = height});
        graph.add_pass(
            "gbuffer", {}, {discarded(g.surface), cleared(g.velocity), cleared(g.depth)}, draw);
        draw_sky_velocity(graph, pass, scene, g);
    } else {
        graph.add_pass("gbuffer", {}, {discarded(g.surface), cleared(g.depth)}, draw);
    }
    return g;
}

}  // namespace limn
