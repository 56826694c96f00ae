#include "render/passes/temporal_pass.h"

#include "render/gpu/shader_library.h"

namespace limn {
namespace {

gpu::Texture make_history(std::string_view label, GLenum format, const TextureSpec& size) {
    gpu::Texture texture(label, {.format = format, .width = size.width, .height = size.height});
    texture.clear(Vec4(0));
    return texture;
}

}  // namespace

Result<TemporalPass> create_temporal_pass(gpu::Device& device) {
    const Result<const gpu::Program*> program =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "temporal.frag"});
    if (!program) {
        return program.error();
    }
    return TemporalPass{*program};
}

TextureId resolve_temporally(
    FrameGraph& graph, TemporalPass& pass, const FrameScene& scene, const Gbuffer& gbuffer,
    TextureId radiance) {
    LIMN_CHECK(gbuffer.velocity.valid());
    const TextureSpec spec = graph.spec(radiance);
    for (int i = 0; i < 2; ++i) {
        const bool fits = pass.history[i] && pass.history[i].width() == spec.width
                          && pass.history[i].height() == spec.height
                          && pass.history[i].desc().format == spec.format;
        if (!fits) {
            pass.history[i] = make_history("temporal history", spec.format, spec);
            pass.moments[i] = make_history("temporal moments", GL_RG32F, spec);
            pass.any = false;
        }
    }
    const bool any = pass.any && scene.since_last.has_value();
    const TextureId before = graph.import("temporal.before", pass.history[pass.newest]);
    const TextureId moments_before =
        graph.import("temporal.moments before", pass.moments[pass.newest]);
    pass.newest = 1 - pass.newest;
    pass.any = true;
    const TextureId resolved = graph.import("temporal", pass.history[pass.newest]);
    const TextureId moments = graph.import("temporal.moments", pass.moments[pass.newest]);
    graph.add_pass(
        "temporal", {radiance, before, moments_before, gbuffer.velocity, gbuffer.depth},
        {discarded(resolved), discarded(moments)},
        [&program = *pass.program, &scene, gbuffer, radiance, before, moments_before,
         any](PassContext& context) {
            context.device().use(gpu::Pipeline{&program, gpu::kFullscreenState});
            bind_view(context.device(), scene);
            program.set("any_history", any ? 1 : 0);
            context.bind_texture(0, radiance);
            context.bind_texture(1, before);
            context.bind_texture(2, gbuffer.velocity);
            context.bind_texture(3, gbuffer.depth);
            context.bind_texture(4, moments_before);
            context.device().draw_fullscreen();
        });
    return resolved;
}

void forget_pictures(TemporalPass& pass) {
    pass.any = false;
}

}  // namespace limn
