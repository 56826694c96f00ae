#pragma once

#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

// Techniques: tex.feedback

/// What one step makes of an image that repeats.
enum class FeedbackRule : std::uint8_t {
    Life,  ///< Conway: a dead cell with three live neighbors is born, one with two or three stays
    Reaction,  ///< two substances that react and diffuse (Gray and Scott): spots, stripes, corals
    Add,       ///< adds `amount`, for tests
};

/// An image that is computed from its previous state, step by step on the GPU (tex.feedback);
/// materials that use the target show it. The state depends on time alone: floor(time * rate) steps
/// from the start.
struct TextureFeedback {
    ImageId start = {};
    ImageId target = {};  ///< rendered to; keeps its size and format
    FeedbackRule rule = FeedbackRule::Life;
    float rate = 12.0f;
    float amount = 1.0f;
    float feed = 0.037f;
    float kill = 0.060f;
    Vec3 low = {0.02f, 0.03f, 0.05f};
    Vec3 high = {0.85f, 0.80f, 0.60f};
    bool operator==(const TextureFeedback&) const = default;
};

LIMN_FIELDS(TextureFeedback) {
    LIMN_FIELD(start, "first state: live, or the second substance, where red is above 0.5");
    LIMN_FIELD(target, "image to render to; the state has its size");
    LIMN_FIELD(rule, .doc = "of a step", .values = "life reaction add");
    LIMN_FIELD(rate, "steps per second; at most 4096 in a frame", "1/s", 0, 1000);
    LIMN_FIELD(amount, "add: to each channel in a step", "", -1000, 1000);
    LIMN_FIELD(feed, "reaction: rate at which the first substance is added", "", 0, 0.2);
    LIMN_FIELD(kill, "reaction: rate at which the second is removed", "", 0, 0.2);
    LIMN_FIELD(low, .doc = "color of dead cells, of none of it", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(
        high, .doc = "color of live cells, of much of it", .min = 0, .max = 1, .color = true);
}

}  // namespace limn
