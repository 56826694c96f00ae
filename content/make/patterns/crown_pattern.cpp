#include "content/make/patterns/crown_pattern.h"

#include "content/make/patterns/flipbook.h"
#include "content/make/patterns/pattern_tools.h"

#include <vector>

namespace limn {
namespace {

constexpr float kFoot = -0.8f;        // in the frame, -1 .. 1
constexpr float kGravity = 4.4f;      // [half frames / duration^2]
constexpr float kDepthScale = 0.22f;  // height in the image per depth: viewed from slightly above

/// Water ejected at one time in one direction.
struct Jet {
    Vec2 around;    ///< on the unit circle: x to the right, y toward the back
    float out = 0;  ///< outward speed
    float up = 0;
    float thick = 0;
};

std::vector<Jet> jets_of(const CrownPattern& pattern) {
    std::vector<Jet> jets;
    const std::uint32_t seed = seed_of(pattern.image);
    const auto random = [&](int jet, std::uint32_t i) {
        return frame_random({{0, 0}, 0}, 1, seed + 16u * static_cast<std::uint32_t>(jet), i);
    };
    for (int i = 0; i < pattern.jets; ++i) {
        const float angle = 2.0f * kPi * (static_cast<float>(i) + 0.8f * random(i, 0))
                            / static_cast<float>(pattern.jets);
        jets.push_back(
            {.around = {std::cos(angle), std::sin(angle)},
             .out = 0.40f + 0.42f * random(i, 1),
             .up = 1.6f + 1.0f * random(i, 2),
             .thick = 0.018f + 0.032f * random(i, 3)});
    }
    return jets;
}

/// Position after `time` of water that left with this fraction of the jet's speed.
Vec2 water_position(const Jet& jet, float speed_fraction, float time) {
    const float away = 0.08f + speed_fraction * jet.out * time;
    const float height =
        std::max(speed_fraction * jet.up * time - 0.5f * kGravity * time * time, 0.0f);
    return {away * jet.around.x, kFoot + height + kDepthScale * away * jet.around.y};
}

}  // namespace

PatternMaps make_crown(const CrownPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const std::vector<Jet> jets = jets_of(pattern);
    const float soft =
        3.0f * static_cast<float>(pattern.frames) / static_cast<float>(pattern.image.size);
    return make_shaded_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const float time = 0.08f + 0.87f * at.time;
        const float whole =
            glm::smoothstep(0.62f, 0.2f, at.time);  // weight of threads, until they tear
        float water = 0;
        for (std::size_t i = 0; i < jets.size(); ++i) {
            const Jet& jet = jets[i];
            const Vec2 tip = water_position(jet, 1.0f, time);
            const Vec2 halfway = water_position(jet, 0.8f, time);
            const Vec2 root = water_position(jet, 0.55f, time);
            const float drop = glm::length(at.p - tip) - 1.5f * jet.thick;
            const float second = glm::length(at.p - halfway) - jet.thick;
            water = std::max(water, glm::smoothstep(soft, -soft, std::min(drop, second)));
            const float thread =
                std::min(line_distance(at.p, tip, halfway), line_distance(at.p, halfway, root));
            const float thin = jet.thick * (0.35f + 0.65f * whole);
            water =
                std::max(water, 0.8f * whole * glm::smoothstep(thin + soft, thin - soft, thread));
            // The translucent wall between this jet and the next.
            const Jet& next = jets[(i + 1) % jets.size()];
            const Vec2 next_root = water_position(next, 0.6f, time);
            const float wall = std::min(
                line_distance(at.p, root, next_root), line_distance(at.p, halfway, next_root));
            water = std::max(water, 0.45f * whole * glm::smoothstep(0.13f, 0.0f, wall));
        }
        const float torn = fbm(5.0f * at.p, seed + 7, {0, 0}, 3);
        PatternTexel t;
        t.color = Vec3(glm::mix(0.75f, 1.0f, water));
        t.opacity = water * std::clamp(1.0f + 0.9f * torn, 0.0f, 1.0f);
        return t;
    });
}

}  // namespace limn
