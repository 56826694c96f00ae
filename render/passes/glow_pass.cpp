#include "render/passes/glow_pass.h"

#include "render/gpu/shader_library.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr int kMostLevels = 14;
/// Standard deviation that level k adds, in its own texels: D and U have variances of 3/4 pixels
/// each a step, which sum to (4^k - 1) / 2.
constexpr float kLevelSigma = 0.7071f;

IVec2 half_of(const IVec2& size) {
    return (size + 1) / 2;
}

bool is_double(const IVec2& large, const IVec2& small) {
    return large == 2 * small;
}

Status load_variants(
    gpu::Device& device,
    const char* fragment,
    std::vector<gpu::ShaderDefine> defines,
    const gpu::Program* (&programs)[2]) {
    for (const gpu::Program*& program : programs) {
        const Result<const gpu::Program*> loaded = device.shaders().load(
            {.vertex = "fullscreen.vert", .fragment = fragment, .defines = defines});
        if (!loaded) {
            return loaded.error();
        }
        program = *loaded;
        defines.push_back({"ANY_SIZE", "1"});
    }
    return Done{};
}

/// The pyramid: levels of half, a quarter ... of the picture's size.
std::vector<TextureId> shrink_picture(
    FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance, int count) {
    std::vector<TextureId> levels;
    TextureId source = radiance;
    const GLenum format = graph.spec(radiance).format;
    for (int i = 0; i < count; ++i) {
        const TextureSpec spec = graph.spec(source);
        const IVec2 large = {spec.width, spec.height};
        const IVec2 small = half_of(large);
        const TextureId target = graph.create(
            {.name = i == 0 ? "glow" : "glow.level",
             .format = format,
             .width = small.x,
             .height = small.y});
        const auto& programs = i == 0 ? pass.first : pass.down;
        graph.add_pass(
            i == 0 ? "glow.first" : "glow.down",
            {source},
            {discarded(target)},
            [program = programs[is_double(large, small) ? 0 : 1],
             per_firefly = glow.firefly > 0 ? 1.0f / glow.firefly : 0.0f,
             source,
             small](PassContext& context) {
                context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
                program->set("per_firefly", per_firefly);
                program->set("size", small);
                context.bind_texture(0, source);
                context.device().draw_fullscreen();
            });
        levels.push_back(target);
        source = target;
    }
    return levels;
}

/// Adds `smaller` times `gain` to `larger`, whose alpha stays.
void add_level(
    FrameGraph& graph, const GlowPass& pass, TextureId smaller, TextureId larger, float gain) {
    const TextureSpec small = graph.spec(smaller);
    const TextureSpec large = graph.spec(larger);
    const IVec2 size = {large.width, large.height};
    graph.add_pass(
        "glow.up",
        {smaller},
        {larger},
        [program = pass.up[is_double(size, {small.width, small.height}) ? 0 : 1],
         smaller,
         size,
         gain](PassContext& context) {
            gpu::PipelineState add = gpu::kFullscreenState;
            add.blend = gpu::kBlendAdd;
            context.device().use(gpu::Pipeline{program, add});
            program->set("gain", gain);
            program->set("size", size);
            context.bind_texture(0, smaller);
            context.device().draw_fullscreen();
        });
}

}  // namespace

Result<GlowPass> create_glow_pass(gpu::Device& device) {
    GlowPass pass;
    const Status loaded[] = {
        load_variants(device, "glow_down.frag", {{"FIRST", "1"}}, pass.first),
        load_variants(device, "glow_down.frag", {}, pass.down),
        load_variants(device, "glow_up.frag", {}, pass.up),
        load_variants(device, "glow_mix.frag", {}, pass.mix)};
    for (const Status& status : loaded) {
        if (!status) {
            return status.error();
        }
    }
    return pass;
}

std::vector<float> glow_weights(const Glow& glow, int width, int height) {
    const float radius = std::max(glow.radius * static_cast<float>(height), 1.0f);  // [px]
    const float depth = std::max(std::log2(radius / kLevelSigma), 1.0f);
    std::vector<float> weights;
    float sum = 0;
    IVec2 size = {width, height};
    for (int i = 1; i <= kMostLevels && (i == 1 || size != IVec2(1)); ++i) {
        // What a level of twice the size adds at its own distance has a quarter of the density.
        const float share = std::clamp(depth - static_cast<float>(i - 1), 0.0f, 1.0f);
        if (share == 0) {
            break;
        }
        weights.push_back(share * std::exp2((2.0f - glow.falloff) * static_cast<float>(i)));
        sum += weights.back();
        size = half_of(size);
    }
    for (float& weight : weights) {
        weight /= sum;
    }
    return weights;
}

TextureId draw_glow(FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance) {
    const TextureSpec spec = graph.spec(radiance);
    const IVec2 size = {spec.width, spec.height};
    const std::vector<float> weights = glow_weights(glow, size.x, size.y);
    const std::vector<TextureId> levels =
        shrink_picture(graph, pass, glow, radiance, static_cast<int>(weights.size()));
    for (std::size_t i = levels.size() - 1; i > 0; --i) {
        add_level(graph, pass, levels[i], levels[i - 1], weights[i] / weights[i - 1]);
    }

    const TextureId glowing = graph.create(
        {.name = "radiance with glow", .format = spec.format, .width = size.x, .height = size.y});
    graph.add_pass(
        "glow",
        {radiance, levels[0]},
        {discarded(glowing)},
        [program = pass.mix[is_double(size, half_of(size)) ? 0 : 1],
         radiance,
         level = levels[0],
         size,
         strength = glow.strength,
         gain = glow.strength * weights[0]](PassContext& context) {
            context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
            program->set("strength", strength);
            program->set("gain", gain);
            program->set("size", size);
            context.bind_texture(0, radiance);
            context.bind_texture(1, level);
            context.device().draw_fullscreen();
        });
    return glowing;
}

}  // namespace limn
