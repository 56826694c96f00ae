#include "content/make/patterns/bubble_pattern.h"

#include "content/make/patterns/flipbook.h"
#include "content/make/patterns/pattern_tools.h"

namespace limn {
namespace {

constexpr float kRadius = 0.8f;   // of half a frame
constexpr float kIndex = 1.333f;  // of water
constexpr float kSkyFrom =
    0.2f;  // upward component of a direction at which the sky brightens, by eye
constexpr float kSkyTo = 0.8f;

/// Fresnel reflectance of unpolarized light from water to air, by the sine of its
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

/// Brightness of the reflection at `point` on the unit disc.
float mirrored_sky(const Vec2& point) {
    const float sine = glm::length(point);
    const float upward = 2.0f * std::sqrt(std::max(1.0f - sine * sine, 0.0f)) * point.y;
    return glm::mix(0.12f, 1.0f, glm::smoothstep(kSkyFrom, kSkyTo, upward));
}

}  // namespace

PatternMaps make_bubble(const BubblePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float soft =
        2.0f * static_cast<float>(pattern.frames) / static_cast<float>(pattern.image.size);
    return make_shaded_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const float flat = pattern.flatness * frame_random(at, pattern.frames, seed, 0);
        const Vec2 point = at.p / (kRadius * Vec2(1.0f, 1.0f - flat));
        const float sine = glm::length(point);
        PatternTexel t;
        t.color = Vec3(mirrored_sky(point));
        t.opacity = reflectance(std::min(sine, 1.0f));
        // Near grazing incidence light is hardly refracted: the background shows through.
        t.opacity *= glm::smoothstep(1.0f + soft, 0.86f, sine);
        return t;
    });
}

}  // namespace limn
