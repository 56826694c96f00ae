#include "render/passes/glare_pass.h"

#include "render/gpu/shader_library.h"

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kMostSteps = 12;

TextureId create_like(FrameGraph& graph, std::string_view name, TextureId other) {
    TextureSpec spec = graph.spec(other);
    spec.name = name;
    return graph.create(spec);
}

/// Adds the line in a direction to `star`.
void draw_line(
    FrameGraph& graph, const GlarePass& pass, TextureId source, const Use& star,
    const Vec2& direction, float half_length) {
    // Tents of half-lengths unit * 2, 4 ... 2^steps; the light of each is half that of the last.
    const int steps =
        std::clamp(static_cast<int>(std::ceil(std::log2(half_length))), 1, kMostSteps);
    const float unit = half_length / std::exp2(static_cast<float>(steps));
    const float whole = 2.0f - std::exp2(1.0f - static_cast<float>(steps));
    TextureId sum = source;
    for (int i = steps - 1; i >= 0; --i) {
        const bool first = i == steps - 1;
        const bool last = i == 0;
        const TextureId next =
            last ? TextureId{star.resource} : create_like(graph, "glare.streak", source);
        const Use target = last ? star : discarded(next);
        graph.add_pass(
            "glare.streak", {source, sum}, {target},
            [&pass, source, sum, last, share = std::exp2(-static_cast<float>(i)) / whole,
             before = first ? 0.0f : 1.0f,
             offset = unit * std::exp2(static_cast<float>(i)) * direction](PassContext& context) {
                gpu::PipelineState state = gpu::kFullscreenState;
                state.blend = last ? gpu::kBlendAdd : gpu::kBlendOff;
                context.device().use(gpu::Pipeline{pass.streak, state});
                pass.streak->set("offset", offset);
                pass.streak->set("share", share);
                pass.streak->set("before", before);
                context.bind_texture(0, source, &pass.dark_outside);
                context.bind_texture(1, sum, &pass.dark_outside);
                context.device().draw_fullscreen();
            });
        sum = next;
    }
}

}  // namespace

Result<GlarePass> create_glare_pass(gpu::Device& device) {
    GlarePass pass;
    struct Wanted {
        const gpu::Program*& program;
        const char* fragment;
    };
    for (const Wanted& wanted :
         {Wanted{pass.source, "glare_source.frag"}, Wanted{pass.streak, "glare_streak.frag"},
          Wanted{pass.add, "glare_add.frag"}}) {
        const Result<const gpu::Program*> program =
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = wanted.fragment});
        if (!program) {
            return program.error();
        }
        wanted.program = *program;
    }
    pass.dark_outside = gpu::Sampler(
        "dark outside", {.minify = GL_LINEAR, .magnify = GL_LINEAR, .wrap = GL_CLAMP_TO_BORDER});
    return pass;
}

int glare_lines(const Glare& glare) {
    const int blades = std::clamp(glare.blades, 3, 16);
    return blades % 2 == 0 ? blades / 2 : blades;
}

TextureId
draw_glare(FrameGraph& graph, const GlarePass& pass, const Glare& glare, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const TextureId source = graph.create(
        {.name = "glare.source",
         .format = spec.format,
         .width = (spec.width + 1) / 2,
         .height = (spec.height + 1) / 2});
    graph.add_pass(
        "glare.source", {radiance}, {discarded(source)},
        [program = pass.source, radiance, threshold = glare.threshold](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("threshold", threshold);
            context.bind_texture(0, radiance);
            context.device().draw_fullscreen();
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
    const TextureId glaring = graph.create(
        {.name = "radiance with glare",
         .format = spec.format,
         .width = spec.width,
         .height = spec.height});
    graph.add_pass(
        "glare", {radiance, star}, {discarded(glaring)},
        [program = pass.add, radiance, star,
         strength = glare.strength / static_cast<float>(lines)](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("strength", strength);
            context.bind_texture(0, radiance);
            context.bind_texture(1, star);
            context.device().draw_fullscreen();
        });
    return glaring;
}

}  // namespace limn
