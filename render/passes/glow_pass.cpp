#include "render/passes/glow_pass.h"

#include "render/gpu/shader_library.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr int kMostLevels = 14;
/// Standard deviation of level k over 2^k pixels. Its variance is the sum of those of the steps
/// down and up: 3/2 for the first, 9/2 pixels for each that follows, which makes 3/2 4^k - 9/2.
constexpr float kLevelSigma = 1.2247f;

IVec2 half_of(const IVec2& size) {
    return (size + 1) / 2;
}

IVec2 size_of(const FrameGraph& graph, TextureId texture) {
    const TextureSpec spec = graph.spec(texture);
    return {spec.width, spec.height};
}

struct ProgramSlot {
    const gpu::Program*& program;
    const char* fragment;
    const char* define;  ///< none if empty
};

/// The first level: half the picture, its alpha how much of its light each texel passes on.
TextureId draw_first(
    FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance, bool even) {
    const IVec2 size = half_of(size_of(graph, radiance));
    const TextureId first = graph.create(
        {.name = "glow", .format = graph.spec(radiance).format, .width = size.x, .height = size.y});
    graph.add_pass(
        "glow.first", {radiance}, {discarded(first)},
        [program = even ? pass.first : pass.first_any,
         per_firefly = glow.firefly > 0 ? 1.0f / glow.firefly : 0.0f, radiance,
         size](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("size", size);
            program->set("per_firefly", per_firefly);
            context.bind_texture(0, radiance);
            context.device().draw_fullscreen();
        });
    return first;
}

/// One axis of a step from `source`.
void draw_axis(
    FrameGraph& graph, std::string_view name, const gpu::Program* program, TextureId source,
    Use target, const IVec2& axis, float gain, const gpu::PipelineState& state) {
    const IVec2 size = size_of(graph, TextureId{target.resource});
    graph.add_pass(
        name, {source}, {target},
        [program, source, axis, gain, state,
         along = size.x * axis.x + size.y * axis.y](PassContext& context) {
            context.device().use(gpu::Pipeline{program, state});
            program->set("axis", axis);
            program->set("sizes", along);
            program->set("gain", gain);
            context.bind_texture(0, source);
            context.device().draw_fullscreen();
        });
}

/// What both axes of a step have between them: the width of `wide`, the height of `high`.
TextureId create_between(FrameGraph& graph, TextureId wide, TextureId high) {
    return graph.create(
        {.name = "glow.between",
         .format = graph.spec(wide).format,
         .width = graph.spec(wide).width,
         .height = graph.spec(high).height});
}

TextureId step_down(FrameGraph& graph, const GlowPass& pass, TextureId larger) {
    const IVec2 size = half_of(size_of(graph, larger));
    const TextureId smaller = graph.create(
        {.name = "glow.level",
         .format = graph.spec(larger).format,
         .width = size.x,
         .height = size.y});
    const TextureId between = create_between(graph, smaller, larger);
    const gpu::PipelineState& state = gpu::kFullscreenState;
    draw_axis(graph, "glow.down", pass.down, larger, discarded(between), {1, 0}, 1, state);
    draw_axis(graph, "glow.down", pass.down, between, discarded(smaller), {0, 1}, 1, state);
    return smaller;
}

/// Draws `smaller` times `gain` into the colors of `larger`, whose alpha stays.
void step_up(
    FrameGraph& graph, const GlowPass& pass, TextureId smaller, TextureId larger, float gain,
    const gpu::BlendState& blend) {
    const TextureId between = create_between(graph, smaller, larger);
    gpu::PipelineState state = gpu::kFullscreenState;
    draw_axis(graph, "glow.up", pass.up, smaller, discarded(between), {0, 1}, gain, state);
    state.blend = blend;
    state.color_mask = 0b0111;
    draw_axis(graph, "glow.up", pass.up, between, Use(larger), {1, 0}, 1, state);
}

}  // namespace

Result<GlowPass> create_glow_pass(gpu::Device& device) {
    GlowPass pass;
    const ProgramSlot slots[] = {
        {pass.first, "glow_first.frag", ""}, {pass.first_any, "glow_first.frag", "ANY_SIZE"},
        {pass.down, "glow_step.frag", ""},   {pass.up, "glow_step.frag", "UP"},
        {pass.mix, "glow_mix.frag", ""},     {pass.mix_any, "glow_mix.frag", "ANY_SIZE"}};
    for (const ProgramSlot& slot : slots) {
        gpu::ProgramDesc desc = {.vertex = "fullscreen.vert", .fragment = slot.fragment};
        if (*slot.define != 0) {
            desc.defines.push_back({slot.define, "1"});
        }
        const Result<const gpu::Program*> program = device.shaders().load(desc);
        if (!program) {
            return program.error();
        }
        slot.program = *program;
    }
    return pass;
}

std::vector<float> glow_weights(const Glow& glow, int width, int height) {
    const float radius = std::max(glow.radius * static_cast<float>(height), 1.0f);  // [px]
    const float depth = std::log2(radius / kLevelSigma);
    std::vector<float> weights;
    float sum = 0;
    IVec2 size = half_of({width, height});
    for (int level = 2; level <= kMostLevels; ++level) {
        const float share = std::clamp(depth - static_cast<float>(level - 1), 0.0f, 1.0f);
        const bool first = level == 2;
        if (!first && (share == 0 || size == IVec2(1))) {
            break;
        }
        // At its own distance, a level of twice the size has a quarter of the density.
        const float density = std::exp2((2.0f - glow.falloff) * static_cast<float>(level));
        weights.push_back(density * (first ? 1.0f : share));
        sum += weights.back();
        size = half_of(size);
    }
    for (float& weight : weights) {
        weight /= sum;
    }
    return weights;
}

TextureId draw_glow(FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance) {
    const IVec2 size = size_of(graph, radiance);
    const bool even = size == 2 * half_of(size);
    const std::vector<float> weights = glow_weights(glow, size.x, size.y);
    std::vector<TextureId> levels = {draw_first(graph, pass, glow, radiance, even)};
    while (levels.size() <= weights.size()) {
        levels.push_back(step_down(graph, pass, levels.back()));
    }
    for (std::size_t i = weights.size() - 1; i > 0; --i) {
        const float gain = weights[i] / weights[i - 1];
        step_up(graph, pass, levels[i + 1], levels[i], gain, gpu::kBlendAdd);
    }
    // The first level is no part of it: it would soften the picture more than make it glow.
    step_up(graph, pass, levels[1], levels[0], weights[0], gpu::kBlendOff);

    const TextureId glowing = graph.create(
        {.name = "radiance with glow",
         .format = graph.spec(radiance).format,
         .width = size.x,
         .height = size.y});
    graph.add_pass(
        "glow", {radiance, levels[0]}, {discarded(glowing)},
        [program = even ? pass.mix : pass.mix_any, radiance, level = levels[0],
         strength = glow.strength](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("strength", strength);
            context.bind_texture(0, radiance);
            context.bind_texture(1, level);
            context.device().draw_fullscreen();
        });
    return glowing;
}

}  // namespace limn
