#include "render/passes/glow_mask_pass.h"

#include "render/gpu/shader_library.h"

#include <algorithm>

namespace limn {
namespace {

constexpr unsigned kSurfaceUnit = 0;
constexpr unsigned kDepthUnit = 1;

}  // namespace

Result<GlowMaskPass> create_glow_mask_pass(gpu::Device& device) {
    GlowMaskPass pass;
    struct Wanted {
        const gpu::Program*& program;
        const char* fragment;
    };
    for (const Wanted& wanted :
         {Wanted{pass.mask, "glow_mask.frag"}, Wanted{pass.add, "glow_add.frag"}}) {
        const Result<const gpu::Program*> program =
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = wanted.fragment});
        if (!program) {
            return program.error();
        }
        wanted.program = *program;
    }
    const Result<SeparableBlur> blur = create_separable_blur(device);
    if (!blur) {
        return blur.error();
    }
    pass.blur = *blur;
    return pass;
}

TextureId draw_glow_mask(
    FrameGraph& graph, const GlowMaskPass& pass, const Glow& glow, const Gbuffer& gbuffer,
    TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    TextureId mask = graph.create(
        {.name = "glow mask",
         .format = spec.format,
         .width = (spec.width + 1) / 2,
         .height = (spec.height + 1) / 2});
    graph.add_pass(
        "glow mask", {gbuffer.surface, gbuffer.depth}, {discarded(mask)},
        [program = pass.mask, gbuffer](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            context.bind_texture(kSurfaceUnit, gbuffer.surface);
            context.bind_texture(kDepthUnit, gbuffer.depth);
            context.device().draw_fullscreen();
        });
    for (int i = 0; i < std::clamp(glow.passes, 1, 16); ++i) {
        mask = blur_separable(graph, pass.blur, "glow mask blur", mask);
    }
    const TextureId glowing = graph.create(
        {.name = "radiance with glow",
         .format = spec.format,
         .width = spec.width,
         .height = spec.height});
    graph.add_pass(
        "glow", {radiance, mask}, {discarded(glowing)},
        [program = pass.add, radiance, mask, strength = glow.strength](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("strength", strength);
            context.bind_texture(0, radiance);
            context.bind_texture(1, mask);
            context.device().draw_fullscreen();
        });
    return glowing;
}

}  // namespace limn
