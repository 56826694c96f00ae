#pragma once

#include "content/make/patterns/noise.h"
#include "content/make/patterns/patterns.h"

#include <cstdint>

namespace limn {

// Helpers of the pattern generators.

[[nodiscard]] inline float
fbm(const Vec2& p, std::uint32_t seed, const IVec2& period, int octaves = 5, float gain = 0.5f) {
    return fractal_noise(p, seed, {.count = octaves, .gain = gain}, period);
}
[[nodiscard]] inline float
fbm(const Vec2& uv, int cells, std::uint32_t seed, int octaves = 5, float gain = 0.5f) {
    return fbm(uv * static_cast<float>(cells), seed, IVec2(cells), octaves, gain);
}

/// Octaves use consecutive seeds, so the seeds of patterns are far apart.
[[nodiscard]] inline std::uint32_t seed_of(const PatternSize& image) {
    return static_cast<std::uint32_t>(image.seed) * 1024u;
}

[[nodiscard]] inline int even(int n) {
    return n + n % 2;
}

/// Lighter or darker by up to `amount`, and a little warmer or colder.
[[nodiscard]] inline Vec3 tinted(const Vec3& color, float amount, std::uint32_t random) {
    const float light = static_cast<float>(random & 0xffffu) / 65535.0f - 0.5f;
    const float warm = static_cast<float>(random >> 16) / 65535.0f - 0.5f;
    const Vec3 tint = 1.0f + amount * (1.2f * light + 0.25f * warm * Vec3(1, 0.1f, -1));
    return color * tint;
}

}  // namespace limn
