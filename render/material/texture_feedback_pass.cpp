#include "render/material/texture_feedback_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/geometry/surface_draws.h"
#include "render/material/drawn_image.h"
#include "render/material/material_pool.h"
#include "render/settings.h"
#include "render/shaders/texture_feedback_gpu.h"

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: tex.feedback

namespace limn {
namespace {

static_assert(static_cast<int>(FeedbackRule::Life) == layout::kFeedbackLife);
static_assert(static_cast<int>(FeedbackRule::Reaction) == layout::kFeedbackReaction);
static_assert(static_cast<int>(FeedbackRule::Add) == layout::kFeedbackAdd);

gpu::Texture make_state(int width, int height) {
    return {"feedback", {.format = GL_RGBA32F, .width = width, .height = height}};
}

std::int64_t steps_until(double time, float rate) {
    const double steps = time * static_cast<double>(rate);
    return steps > 0 ? static_cast<std::int64_t>(std::min(std::floor(steps + 1e-6), 1e15)) : 0;
}

}  // namespace

Result<TextureFeedbackEffect>
TextureFeedbackEffect::create(gpu::Device& device, const RenderSettings&) {
    return TextureFeedbackEffect{
        LIMN_TRY(device.shaders().load({.compute = "texture_feedback.comp"})),
        LIMN_TRY(load_fullscreen(device, "texture_feedback.frag")),
        gpu::Sampler("feedback", {.minify = GL_NEAREST, .magnify = GL_NEAREST})};
}

bool TextureFeedbackEffect::is_used(const FrameData& frame) {
    return !frame.world->query<const TextureFeedback>().empty();
}

void TextureFeedbackEffect::collect(FrameData& frame) {
    const ImagePool& images = frame.materials->images();
    auto& drawn = frame.data.publish<FeedbackImages>();
    drawn.arrays.clear();
    frame.world->query<const TextureFeedback>().each([&](const TextureFeedback& feedback) {
        drawn.arrays.push_back(&images.array(find_drawn_image(images, feedback.target).array));
    });
    if (std::exchange(assets, frame.assets_identity) != frame.assets_identity) {
        states.clear();
    }
}

void TextureFeedbackEffect::draw_shared(FrameGraph& graph, const FrameData& frame) {
    std::size_t count = 0;
    states.resize(frame.world->query<const TextureFeedback>().count());
    frame.world->query<const TextureFeedback>().each([&](const TextureFeedback& feedback) {
        draw_one(graph, frame, within_ranges(feedback), states[count++]);
    });
}

void TextureFeedbackEffect::draw_one(
    FrameGraph& graph, const FrameData& frame, const TextureFeedback& settings, State& state) {
    const ImagePool& images = frame.materials->images();
    const ImageLayer target = find_drawn_image(images, settings.target);
    if (images.find_texture(settings.start) == nullptr || target.array == 0
        || settings.start == settings.target) {
        return;
    }
    const gpu::Texture& array = images.array(target.array);
    const std::int64_t end = steps_until(frame.time, settings.rate);
    if (!state.textures[0] || state.textures[0].width() != array.width()
        || state.textures[0].height() != array.height() || state.settings != settings
        || state.steps > end) {
        state.textures[0] = make_state(array.width(), array.height());
        state.textures[1] = make_state(array.width(), array.height());
        state.settings = settings;
        state.steps = -1;
    }
    if (state.steps < end) {
        add_steps(graph, frame, settings, state, std::min(end, state.steps + kMaxFeedbackSteps));
    }
    const TextureId drawn = create_drawn_image(graph, images, target);
    add_fullscreen_pass(
        graph, "draw feedback",
        {sampled(
            graph.import("feedback", state.textures[state.newest]), layout::kFeedbackStateUnit,
            &nearest)},
        {target_level(discarded(drawn), 0)}, show,
        [&array, settings](PassContext&, const gpu::Program& shader) {
            shader.set("rule", static_cast<int>(settings.rule));
            shader.set("low", settings.low);
            shader.set("high", settings.high);
            shader.set("encoded", array.desc().format == GL_SRGB8_ALPHA8 ? 1 : 0);
        });
    store_drawn_image(graph, images, drawn, target);
}

/// Steps until `end` have been taken, from the start if there is no state yet.
void TextureFeedbackEffect::add_steps(
    FrameGraph& graph, const FrameData& frame, const TextureFeedback& settings, State& state,
    std::int64_t end) {
    const gpu::Texture& start = *frame.materials->images().find_texture(settings.start);
    const TextureId states_of[2] = {
        graph.import("feedback", state.textures[0]), graph.import("feedback", state.textures[1])};
    const int first = state.newest;
    const auto count = static_cast<int>(end - state.steps);
    const bool starts = state.steps < 0;
    graph.add_pass(
        "texture feedback",
        {sampled(graph.import("feedback start", start), layout::kFeedbackStartUnit, &nearest)},
        {image(states_of[0]), image(states_of[1])},
        [this, settings, a = states_of[0], b = states_of[1], first, count, starts,
         width = state.textures[0].width(),
         height = state.textures[0].height()](PassContext& context) {
            context.device().use(*step);
            step->set("amount", settings.amount);
            step->set("feed_kill", Vec2(settings.feed, settings.kill));
            step->set("next_rule", static_cast<int>(settings.rule));
            for (int i = 0; i < count; ++i) {
                const bool swapped = (first + i) % 2 != 0;
                step->set(
                    "rule",
                    starts && i == 0 ? layout::kFeedbackStart : static_cast<int>(settings.rule));
                context.bind_image(layout::kFeedbackFromImage, swapped ? b : a, GL_READ_ONLY);
                context.bind_image(layout::kFeedbackToImage, swapped ? a : b, GL_WRITE_ONLY);
                context.device().dispatch_over(
                    width, height, static_cast<int>(layout::kFeedbackGroup));
                glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
            }
        });
    state.newest = (first + count) % 2;
    state.steps = end;
}

}  // namespace limn
