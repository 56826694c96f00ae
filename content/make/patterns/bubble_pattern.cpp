#include "content/make/patterns/bubble_pattern.h"

#include "content/make/patterns/flipbook.h"
#include "content/make/patterns/pattern_tools.h"

namespace limn {
namespace {

constexpr float kRadius = 0.8f;   // of half a frame
constexpr float kIndex = 1.333f;  // of water
constexpr float kSkyFrom = 0.2f;  // upward share of a direction in which it gets bright, by eye
constexpr float kSkyTo = 0.8f;

/// Share of unpolarized light that goes from water to air and is reflected, by the sine of its
/// angle of incidence.
float reflectance(float sine) {
    const float leaving = kIndex * sine;
    if (leaving >= 1.0f) {
        return 1.0f;
    }
    const float in = std::sqrt(1.0f - sine * sine);
    const float out = std::sqrt(1.0f - leaving * leaving);
    const float s = (kIndex * in - out) / (kIndex * in + out);
    const float p = (in - kIndex * out) / (in + kIndex * out);
    return 0.5f * (s * s + p * p);
}

/// Brightness of what is seen at `place` on the unit disc, by reflection.
float mirrored_sky(const Vec2& place) {
    const float sine = glm::length(place);
    const float upward = 2.0f * std::sqrt(std::max(1.0f - sine * sine, 0.0f)) * place.y;
    return glm::mix(0.12f, 1.0f, glm::smoothstep(kSkyFrom, kSkyTo, upward));
}

}  // namespace

PatternMaps make_bubble(const BubblePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float soft =
        2.0f * static_cast<float>(pattern.frames) / static_cast<float>(pattern.image.size);
    return make_shaded_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const float flat = pattern.flatness * frame_random(at, pattern.frames, seed, 0);
        const Vec2 place = at.p / (kRadius * Vec2(1.0f, 1.0f - flat));
        const float sine = glm::length(place);
        PatternTexel t;
        t.color = Vec3(mirrored_sky(place));
        t.opacity = reflectance(std::min(sine, 1.0f));
        // Grazing light hardly changes its direction: there one sees what is behind.
        t.opacity *= glm::smoothstep(1.0f + soft, 0.86f, sine);
        return t;
    });
}

}  // namespace limn
