#include "content/make/sprite_patterns.h"

#include "content/make/pattern_tools.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// A point of a flipbook: -1 .. 1 in its frame, y upwards, and the frame's share of the sequence.
struct FramePoint {
    Vec2 p;
    float time;
};

template <typename Opacity>
PatternMaps make_flipbook(const PatternSize& image, int frames, Opacity&& opacity) {
    const float side = static_cast<float>(frames);
    return make_pattern_maps(image.size, [&](const Vec2& uv) {
        const Vec2 cell = glm::floor(uv * side);
        const Vec2 inside = 2.0f * (uv * side - cell) - 1.0f;
        const FramePoint at = {
            {inside.x, -inside.y}, (cell.y * side + cell.x) / std::max(side * side - 1.0f, 1.0f)};
        // Nothing at the border, over which filters read the neighboring frames.
        const float edge = std::max(std::abs(inside.x), std::abs(inside.y));
        PatternTexel t;
        t.color = {1, 1, 1};
        t.opacity = std::clamp(opacity(at), 0.0f, 1.0f) * glm::smoothstep(0.97f, 0.85f, edge);
        return t;
    });
}

/// Noise that changes with time: two layers that drift apart.
float moving_noise(const Vec2& p, const Vec2& drift, std::uint32_t seed, int octaves) {
    return 0.6f
           * (fbm(p + drift, seed, {0, 0}, octaves)
              + fbm(p - 0.7f * drift + 7.3f, seed + 50, {0, 0}, octaves));
}

}  // namespace

PatternMaps make_smoke(const SmokePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const Vec2 drift = at.time * Vec2(0.5f, -0.8f);
        const Vec2 warp = {
            moving_noise(1.4f * at.p, drift, seed, 4),
            moving_noise(1.4f * at.p + 31.0f, drift, seed, 4)};
        const float radius = glm::length(at.p + 0.45f * warp);
        const float body = glm::smoothstep(0.95f, 0.1f, radius);
        const float billows = moving_noise(2.6f * (at.p + 0.5f * warp), drift, seed + 200, 5);
        const float frayed =
            glm::smoothstep(-0.55f + 0.3f * at.time, 0.65f, billows + 0.6f * body - 0.25f);
        return body * glm::mix(1.0f, frayed * 1.3f, pattern.detail);
    });
}

PatternMaps make_flame(const FlamePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const Vec2 rise = at.time * Vec2(0.15f, -2.2f);
        const float height = 0.5f * (at.p.y + 1.0f);
        const float sway = moving_noise(Vec2(0.9f, 1.3f) * at.p, rise, seed, 3);
        const float lick = moving_noise(Vec2(2.4f, 1.7f) * at.p, 1.3f * rise, seed + 200, 4);
        const float x = at.p.x + 0.75f * height * sway;
        // Widest at a quarter of the height, a point at the top.
        const float width = 0.62f * std::pow(std::max(1.0f - height, 0.0f), 0.75f)
                            * glm::smoothstep(-0.02f, 0.3f, height);
        const float body = glm::smoothstep(1.0f, 0.15f, std::abs(x) / std::max(width, 1e-3f));
        const float torn =
            glm::smoothstep(-0.5f, 0.45f, lick + 0.55f - 0.9f * height * (0.6f + 0.6f * at.time));
        return body * glm::mix(1.0f, torn, pattern.detail);
    });
}

}  // namespace limn
