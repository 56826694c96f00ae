#include "render/lens/glare_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/settings.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/glare_gpu.h"

#include <algorithm>
#include <cmath>

// Techniques: post.glare-heat-haze

namespace limn {
namespace {

constexpr int kMaxGlareSteps = 12;

/// Adds the streak along `direction`, to both sides, to `star`.
void draw_line(
    FrameGraph& graph, const GlarePass& pass, TextureId source, const Use& star,
    const Vec2& direction, float half_length) {
    // Tents of half-lengths unit * 2, 4 ... 2^steps; the light of each is half that of the last.
    const int steps =
        std::clamp(static_cast<int>(std::ceil(std::log2(half_length))), 1, kMaxGlareSteps);
    const float unit = half_length / std::exp2(static_cast<float>(steps));
    const float whole = 2.0f - std::exp2(1.0f - static_cast<float>(steps));
    TextureId sum = source;
    for (int i = steps - 1; i >= 0; --i) {
        const bool first = i == steps - 1;
        const bool last = i == 0;
        const TextureId next =
            last ? TextureId{star.resource} : create_like(graph, "glare.streak", source);
        const Use target = last ? star : discarded(next);
        gpu::PipelineState state = gpu::kFullscreenState;
        state.blend = last ? gpu::kBlendAdd : gpu::kBlendOff;
        add_fullscreen_pass(
            graph, "glare.streak",
            {sampled(source, layout::kSourceUnit, &pass.black_border),
             sampled(sum, layout::kGlareSumUnit, &pass.black_border)},
            {target}, pass.streak, state,
            [source_weight = std::exp2(-static_cast<float>(i)) / whole,
             sum_weight = first ? 0.0f : 1.0f,
             offset = unit * std::exp2(static_cast<float>(i))
                      * direction](PassContext&, const gpu::Program& program) {
                program.set("offset", offset);
                program.set("source_weight", source_weight);
                program.set("sum_weight", sum_weight);
            });
        sum = next;
    }
}

Glare glare_of(const FrameData& frame) {
    const auto* glare = frame.world->find_resource<Glare>();
    return glare != nullptr ? within_ranges(*glare) : Glare{.strength = 0};
}

}  // namespace

Result<GlarePass> create_glare_pass(gpu::Device& device) {
    return GlarePass{
        LIMN_TRY(load_fullscreen(device, "glare_source.frag")),
        LIMN_TRY(load_fullscreen(device, "glare_streak.frag")),
        LIMN_TRY(load_fullscreen(device, "glare_add.frag")),
        gpu::Sampler(
            "black border",
            {.minify = GL_LINEAR, .magnify = GL_LINEAR, .wrap = GL_CLAMP_TO_BORDER})};
}

int glare_lines(const Glare& glare) {
    const int blades = std::clamp(glare.blades, 3, 16);
    return blades % 2 == 0 ? blades / 2 : blades;
}

TextureId
draw_glare(FrameGraph& graph, const GlarePass& pass, const Glare& glare, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const TextureId source = create_target(
        graph, "glare.source", spec.format, half_resolution({spec.width, spec.height}));
    add_fullscreen_pass(
        graph, "glare.source", {sampled(radiance, layout::kSourceUnit)}, {discarded(source)},
        pass.source, [threshold = glare.threshold](PassContext&, const gpu::Program& program) {
            program.set("threshold", threshold);
        });
    const TextureId star = create_like(graph, "glare.star", source);
    const int lines = glare_lines(glare);
    const float half_length = std::max(0.5f * glare.length * static_cast<float>(spec.height), 2.0f);
    for (int i = 0; i < lines; ++i) {
        const float angle =
            glare.rotation + kPi * static_cast<float>(i) / static_cast<float>(lines);
        draw_line(
            graph, pass, source, i == 0 ? cleared(star) : Use(star),
            {std::cos(angle), std::sin(angle)}, half_length);
    }
    const TextureId glaring = create_like(graph, "radiance with glare", radiance);
    add_fullscreen_pass(
        graph, "glare",
        {sampled(radiance, layout::kSourceUnit), sampled(star, layout::kGlareSumUnit)},
        {discarded(glaring)}, pass.add,
        [strength = glare.strength / static_cast<float>(lines)](
            PassContext&, const gpu::Program& program) { program.set("strength", strength); });
    return glaring;
}

Result<GlareEffect> GlareEffect::create(gpu::Device& device, const RenderSettings&) {
    return GlareEffect{LIMN_TRY(create_glare_pass(device))};
}

bool GlareEffect::is_used(const FrameData& frame) {
    return glare_of(frame).strength > 0;
}

void GlareEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    view.radiance = draw_glare(graph, pass, glare_of(frame), view.radiance);
}

}  // namespace limn
