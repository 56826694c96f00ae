#include "render/lens/glow_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/settings.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/glow_gpu.h"

#include <algorithm>
#include <cmath>

// Techniques: post.glow

namespace limn {
namespace {

constexpr int kMaxLevels = 14;
/// Standard deviation of level k, in units of 2^k pixels. Its variance is the sum over the steps
/// down and up: 3/2 for the first, 9/2 pixels for each that follows, which gives 3/2 4^k - 9/2.
constexpr float kLevelSigma = 1.2247f;

/// The first level, at half resolution; alpha is the fraction of its light each texel passes on.
TextureId draw_first(
    FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance, bool even) {
    const IVec2 size = half_resolution(size_of(graph, radiance));
    const TextureId first = create_target(graph, "glow", graph.spec(radiance).format, size);
    add_fullscreen_pass(
        graph, "glow.first", {sampled(radiance, layout::kSourceUnit)}, {discarded(first)},
        even ? pass.first : pass.first_odd,
        [size, inverse_firefly = glow.firefly > 0 ? 1.0f / glow.firefly : 0.0f](
            PassContext&, const gpu::Program& program) {
            program.set("size", size);
            program.set("inverse_firefly", inverse_firefly);
        });
    return first;
}

constexpr int kTwiceBorder = 5;  // texels beyond the border that glow_step.frag reads at most

int length_along(const IVec2& axis, const IVec2& size) {
    return size.x * axis.x + size.y * axis.y;
}

const gpu::Program* down_program(const GlowPass& pass, int from, int to) {
    return from == 2 * to && from >= kTwiceBorder ? pass.down_twice : pass.down;
}

const gpu::Program* up_program(const GlowPass& pass, int from, int to) {
    return to == 2 * from ? pass.up_twice : pass.up;
}

/// One axis of a step from `source`, by the program for these lengths.
void draw_axis(
    FrameGraph& graph, const GlowPass& pass, bool up, TextureId source, Use target,
    const IVec2& axis, float gain, const gpu::PipelineState& state) {
    const int from = length_along(axis, size_of(graph, source));
    const int to = length_along(axis, size_of(graph, TextureId{target.resource}));
    add_fullscreen_pass(
        graph, up ? "glow.up" : "glow.down", {sampled(source, layout::kSourceUnit)}, {target},
        up ? up_program(pass, from, to) : down_program(pass, from, to), state,
        [axis, gain, to](PassContext&, const gpu::Program& shader) {
            shader.set("axis", axis);
            shader.set("sizes", to);
            shader.set("gain", gain);
        });
}

/// Intermediate target of a separable step: the width of `wide`, the height of `high`.
TextureId create_between(FrameGraph& graph, TextureId wide, TextureId high) {
    return create_target(
        graph, "glow.between", graph.spec(wide).format,
        {graph.spec(wide).width, graph.spec(high).height});
}

TextureId step_down(FrameGraph& graph, const GlowPass& pass, TextureId larger) {
    const TextureId smaller = create_target(
        graph, "glow.level", graph.spec(larger).format, half_resolution(size_of(graph, larger)));
    const TextureId between = create_between(graph, smaller, larger);
    const gpu::PipelineState& state = gpu::kFullscreenState;
    draw_axis(graph, pass, false, larger, discarded(between), {1, 0}, 1, state);
    draw_axis(graph, pass, false, between, discarded(smaller), {0, 1}, 1, state);
    return smaller;
}

/// Draws `smaller` times `gain` into the colors of `larger`, whose alpha stays.
void step_up(
    FrameGraph& graph, const GlowPass& pass, TextureId smaller, TextureId larger, float gain,
    const gpu::BlendState& blend) {
    const TextureId between = create_between(graph, smaller, larger);
    gpu::PipelineState state = gpu::kFullscreenState;
    draw_axis(graph, pass, true, smaller, discarded(between), {0, 1}, gain, state);
    state.blend = blend;
    state.color_mask = 0b0111;
    draw_axis(graph, pass, true, between, Use(larger), {1, 0}, 1, state);
}

/// The image combined with its glow by `program`.
TextureId compose(
    FrameGraph& graph, const gpu::Program* program, TextureId radiance, TextureId glow,
    float strength) {
    const TextureId glowing = create_like(graph, "radiance with glow", radiance);
    add_fullscreen_pass(
        graph, "glow", {sampled(radiance, layout::kSourceUnit), sampled(glow, layout::kGlowUnit)},
        {discarded(glowing)}, program,
        [strength](PassContext&, const gpu::Program& shader) { shader.set("strength", strength); });
    return glowing;
}

Result<GlowMaskPass> create_glow_mask_pass(gpu::Device& device) {
    return GlowMaskPass{
        LIMN_TRY(load_fullscreen(device, "glow_mask.frag")),
        LIMN_TRY(load_fullscreen(device, "glow_add.frag")),
        LIMN_TRY(create_separable_blur(device))};
}

TextureId draw_glow_mask(
    FrameGraph& graph, const GlowMaskPass& pass, const Glow& glow, const Gbuffer& gbuffer,
    TextureId radiance) {
    TextureId mask = create_target(
        graph, "glow mask", graph.spec(radiance).format, half_resolution(size_of(graph, radiance)));
    add_fullscreen_pass(
        graph, "glow mask",
        {sampled(gbuffer.surface, layout::kGlowSurfaceUnit),
         sampled(gbuffer.depth, layout::kGlowDepthUnit)},
        {discarded(mask)}, pass.mask);
    for (int i = 0; i < std::clamp(glow.passes, 1, 16); ++i) {
        mask = blur_separable(graph, pass.blur, "glow mask blur", mask);
    }
    return compose(graph, pass.add, radiance, mask, glow.strength);
}

Glow glow_of(const FrameData& frame) {
    const auto* glow = frame.world->find_resource<Glow>();
    return glow != nullptr ? within_ranges(*glow) : Glow{.strength = 0};
}

}  // namespace

Result<GlowPass> create_glow_pass(gpu::Device& device) {
    return GlowPass{
        .first = LIMN_TRY(load_fullscreen(device, "glow_first.frag")),
        .first_odd = LIMN_TRY(load_fullscreen(device, "glow_first.frag", {{"ANY_SIZE"}})),
        .down = LIMN_TRY(load_fullscreen(device, "glow_step.frag")),
        .up = LIMN_TRY(load_fullscreen(device, "glow_step.frag", {{"UP"}})),
        .down_twice = LIMN_TRY(load_fullscreen(device, "glow_step.frag", {{"TWICE"}})),
        .up_twice = LIMN_TRY(load_fullscreen(device, "glow_step.frag", {{"UP"}, {"TWICE"}})),
        .mix = LIMN_TRY(load_fullscreen(device, "glow_mix.frag")),
        .mix_odd = LIMN_TRY(load_fullscreen(device, "glow_mix.frag", {{"ANY_SIZE"}}))};
}

std::vector<float> glow_weights(const Glow& glow, int width, int height) {
    const float radius = std::max(glow.radius * static_cast<float>(height), 1.0f);  // [px]
    const float depth = std::log2(radius / kLevelSigma);
    std::vector<float> weights;
    float sum = 0;
    IVec2 size = half_resolution({width, height});
    for (int level = 2; level <= kMaxLevels; ++level) {
        const float fade = std::clamp(depth - static_cast<float>(level - 1), 0.0f, 1.0f);
        const bool first = level == 2;
        if (!first && (fade == 0 || size == IVec2(1))) {
            break;
        }
        // A level of twice the size has a quarter of the density.
        const float density = std::exp2((2.0f - glow.falloff) * static_cast<float>(level));
        weights.push_back(density * (first ? 1.0f : fade));
        sum += weights.back();
        size = half_resolution(size);
    }
    for (float& weight : weights) {
        weight /= sum;
    }
    return weights;
}

TextureId draw_glow(FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance) {
    const IVec2 size = size_of(graph, radiance);
    const bool even = size == 2 * half_resolution(size);
    const std::vector<float> weights = glow_weights(glow, size.x, size.y);
    std::vector<TextureId> levels = {draw_first(graph, pass, glow, radiance, even)};
    while (levels.size() <= weights.size()) {
        levels.push_back(step_down(graph, pass, levels.back()));
    }
    for (std::size_t i = weights.size() - 1; i > 0; --i) {
        const float gain = weights[i] / weights[i - 1];
        step_up(graph, pass, levels[i + 1], levels[i], gain, gpu::kBlendAdd);
    }
    // The first level is left out: it would soften the image rather than make it glow.
    step_up(graph, pass, levels[1], levels[0], weights[0], gpu::kBlendOff);

    return compose(graph, even ? pass.mix : pass.mix_odd, radiance, levels[0], glow.strength);
}

Result<GlowEffect> GlowEffect::create(gpu::Device& device, const RenderSettings&) {
    return GlowEffect{LIMN_TRY(create_glow_pass(device)), LIMN_TRY(create_glow_mask_pass(device))};
}

bool GlowEffect::is_used(const FrameData& frame) {
    const Glow glow = glow_of(frame);
    const std::uint32_t kinds = glow.kind == GlowKind::Mask ? kMainViews : kFilmViews;
    return glow.strength > 0 && (frame.kind & kinds) != 0;
}

void GlowEffect::collect(FrameData& frame) {
    frame.attributes |= glow_of(frame).kind == GlowKind::Mask;
}

void GlowEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const Glow glow = glow_of(frame);
    view.radiance = glow.kind == GlowKind::Mask
                        ? draw_glow_mask(graph, mask, glow, view.gbuffer, view.radiance)
                        : draw_glow(graph, lens, glow, view.radiance);
}

}  // namespace limn
