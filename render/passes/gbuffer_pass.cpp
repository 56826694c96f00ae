#include "render/passes/gbuffer_pass.h"

namespace limn {

Result<GbufferPass> create_gbuffer_pass(gpu::Device& device) {
    GbufferPass pass = {SurfacePrograms(device, "mesh.vert", "gbuffer.frag")};
    const Status plain = pass.programs.load(0, 0, {});
    if (!plain) {
        return plain.error();
    }
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
        draw_runs(
            context.device(),
            scene,
            scene.instances.opaque,
            pass.programs,
            velocity ? kVelocity : 0u,
            0,
            {},
            {});
    };
    if (velocity) {
        g.velocity = graph.create(
            {.name = "gbuffer.velocity", .format = GL_RG16F, .width = width, .height = height});
        graph.add_pass(
            "gbuffer", {}, {discarded(g.surface), cleared(g.velocity), cleared(g.depth)}, draw);
    } else {
        graph.add_pass("gbuffer", {}, {discarded(g.surface), cleared(g.depth)}, draw);
    }
    return g;
}

}  // namespace limn
