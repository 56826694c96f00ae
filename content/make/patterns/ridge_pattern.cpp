#include "content/make/patterns/ridge_pattern.h"

#include "content/make/patterns/pattern_tools.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {
namespace {

constexpr float kNearest = 0.16f;  // height of the nearest crest / that of the farthest

/// One crest, a function of the position around the horizon.
struct Crest {
    std::uint32_t seed = 0;
    int cells = 4;      ///< of its largest hills around the horizon
    float base = 0;     ///< mean height above the horizon [half image heights]
    float relief = 0;   ///< amplitude of its hills [half image heights]
    float trees = 0;    ///< height of the trees along it [half image heights]
    float spots = 1;    ///< frequency of woods and meadows [per half image height]
    float opacity = 1;  ///< transmittance of the air in front of it
};

std::vector<Crest> crests_of(const RidgePattern& pattern) {
    std::vector<Crest> crests;
    for (int i = 0; i < pattern.crests; ++i) {
        // 0: the farthest, 1: the nearest
        const float near =
            pattern.crests > 1 ? static_cast<float>(i) / static_cast<float>(pattern.crests - 1) : 0;
        const float height = pattern.height * glm::mix(1.0f, kNearest, std::pow(near, 0.8f));
        crests.push_back(
            {.seed = seed_of(pattern.image) + 64u * static_cast<std::uint32_t>(i),
             .cells = 3 + 2 * i,
             .base = 0.62f * height,
             .relief = 0.62f * height,
             .trees = 0.009f * (0.4f + near),
             .spots = glm::mix(16.0f, 7.0f, near),
             .opacity = 1 - pattern.air * square(1 - near)});
    }
    return crests;
}

/// Cells of noise around the horizon whose size is `cell` [half image heights].
int cells_of(const RidgePattern& pattern, float cell) {
    return std::max(static_cast<int>(2 * pattern.aspect / cell + 0.5f), 1);
}

/// Height above the horizon at `u` [half image heights].
float height_of(const RidgePattern& pattern, const Crest& crest, float u) {
    const auto noise = [&](int cells, std::uint32_t seed, int octaves, float gain) {
        return fbm(
            {u * static_cast<float>(cells), 0.37f}, crest.seed + seed, {cells, 0}, octaves, gain);
    };
    const float height = crest.base + crest.relief * noise(crest.cells, 0, 6, 0.45f)
                         + crest.trees * noise(cells_of(pattern, 2 * crest.trees), 16, 2, 0.6f);
    constexpr float kHighest = 0.97f;  // inside the image
    return std::min(height, kHighest);
}

/// Radiance of the slope this far below the crest [half image heights].
Vec3 slope_color(const RidgePattern& pattern, const Crest& crest, float u, float below) {
    constexpr float kForeshortened = 2.5f;  // spots are wider than they are high
    const int cells = cells_of(pattern, kForeshortened / crest.spots);
    const Vec2 at = {u * static_cast<float>(cells), crest.spots * below};
    const auto noise = [&](int finer, std::uint32_t seed, int octaves, float gain) {
        return fbm(
            static_cast<float>(finer) * at, crest.seed + seed, {finer * cells, 0}, octaves, gain);
    };
    const float wood =
        glm::smoothstep(-0.1f, 0.1f, noise(1, 32, 5, 0.55f) + 0.9f * (pattern.wooded - 0.5f));
    const float leaves = noise(8, 48, 3, 0.75f);
    const float light = 1 + 0.9f * leaves * wood + 0.7f * noise(1, 56, 2, 0.5f);
    return glm::mix(pattern.bare_color, pattern.color, wood) * std::max(light, 0.2f);
}

}  // namespace

PatternMaps make_ridges(const RidgePattern& pattern) {
    const std::vector<Crest> crests = crests_of(pattern);
    const float pixel = 2.0f / static_cast<float>(pattern.image.size);  // [half image heights]
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float y = 1 - 2 * uv.y;
        Vec3 color = 0.5f * (pattern.color + pattern.bare_color);
        float opacity = 0;
        for (const Crest& crest : crests) {
            const float below = height_of(pattern, crest, uv.x) - y;
            const float covered = glm::clamp(0.5f + below / pixel, 0.0f, 1.0f);
            if (covered <= 0) {
                continue;
            }
            const Vec3 slope = slope_color(pattern, crest, uv.x, below);
            // The color of what is transparent matters where texels are averaged.
            color = opacity > 0 ? glm::mix(color, slope, covered) : slope;
            opacity = glm::mix(opacity, crest.opacity, covered);
        }
        return PatternTexel{.color = color, .roughness = 1, .opacity = opacity};
    });
}

}  // namespace limn
