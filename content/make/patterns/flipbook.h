#pragma once

#include "content/make/patterns/pattern_maps.h"
#include "content/make/patterns/patterns.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace limn {

// Images of `frames` x `frames` shapes, each transparent at its border, in order from the top left.

/// A point of a flipbook: -1 .. 1 in its frame, y upwards, and the frame's time in the sequence, 0
/// .. 1.
struct FramePoint {
    Vec2 p;
    float time;
};

/// `texel`: color and opacity of a FramePoint.
template <typename Texel>
[[nodiscard]] PatternMaps
make_shaded_flipbook(const PatternSize& image, int frames, Texel&& texel) {
    const float side = static_cast<float>(frames);
    return make_pattern_maps(image.size, [&](const Vec2& uv) {
        const Vec2 cell = glm::floor(uv * side);
        const Vec2 inside = 2.0f * (uv * side - cell) - 1.0f;
        const FramePoint at = {
            {inside.x, -inside.y}, (cell.y * side + cell.x) / std::max(side * side - 1.0f, 1.0f)};
        // Transparent at the border, since filtering reads texels of neighboring frames.
        const float edge = std::max(std::abs(inside.x), std::abs(inside.y));
        PatternTexel t = texel(at);
        t.opacity = std::clamp(t.opacity, 0.0f, 1.0f) * glm::smoothstep(0.97f, 0.85f, edge);
        return t;
    });
}

/// White with this opacity.
template <typename Opacity>
[[nodiscard]] PatternMaps make_flipbook(const PatternSize& image, int frames, Opacity&& opacity) {
    return make_shaded_flipbook(image, frames, [&](const FramePoint& at) {
        PatternTexel t;
        t.color = {1, 1, 1};
        t.opacity = opacity(at);
        return t;
    });
}

[[nodiscard]] inline std::uint32_t frame_number(const FramePoint& at, int frames) {
    return static_cast<std::uint32_t>(
        std::floor(at.time * static_cast<float>(frames * frames - 1) + 0.5f));
}

/// 0 .. 1, of a frame.
[[nodiscard]] inline float
frame_random(const FramePoint& at, int frames, std::uint32_t seed, std::uint32_t index) {
    const std::uint32_t number = frame_number(at, frames);
    std::uint32_t h = (number * 64u + index + seed) * 0x9e3779b9u;
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return static_cast<float>((h ^ (h >> 16)) >> 8) * 0x1p-24f;
}

/// Distance from a point to the line segment between two others.
[[nodiscard]] inline float line_distance(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 along = b - a;
    const float t = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0f, 1.0f);
    return glm::length(p - a - t * along);
}

}  // namespace limn
