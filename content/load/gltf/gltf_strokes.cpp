#include "content/load/gltf/gltf_strokes.h"

#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace limn {
namespace {

constexpr float kPointRadius = 0.005f;  // of half the diagonal of all positions; by eye
constexpr float kLineRadius = 0.003f;   // likewise
constexpr int kSides = 3;               // of a line

float size_of(std::span<const Vec3> positions, std::span<const std::uint32_t> list) {
    Bounds bounds;
    for (const std::uint32_t index : list) {
        if (is_finite(positions[index])) {
            grow(bounds, positions[index]);
        }
    }
    const float size = is_empty(bounds) ? 0.0f : glm::length(half_extent(bounds));
    return size > 0 ? size : 1.0f;
}

void add_vertex(Strokes& strokes, std::uint32_t source, const Vec3& normal, float radius) {
    strokes.sources.push_back(source);
    strokes.offsets.push_back(radius * normal);
    strokes.normals.push_back(normal);
}

void add_point(Strokes& strokes, std::uint32_t source, float radius) {
    constexpr std::array<std::uint32_t, 24> kFaces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                                      2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    const auto first = static_cast<std::uint32_t>(strokes.sources.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {1.0f, -1.0f}) {
            Vec3 normal(0);
            normal[axis] = side;
            add_vertex(strokes, source, normal, radius);
        }
    }
    for (const std::uint32_t corner : kFaces) {
        strokes.indices.push_back(first + corner);
    }
}

void add_line(
    Strokes& strokes, std::span<const Vec3> positions, std::pair<std::uint32_t, std::uint32_t> ends,
    float radius) {
    if (!is_finite(positions[ends.first]) || !is_finite(positions[ends.second])) {
        return;
    }
    const Vec3 along = normalize_or(positions[ends.second] - positions[ends.first], Vec3(0));
    if (along == Vec3(0)) {
        return;
    }
    const Vec3 x = any_perpendicular(along);
    const Vec3 y = glm::cross(along, x);
    const auto first = static_cast<std::uint32_t>(strokes.sources.size());
    for (int i = 0; i < kSides; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / kSides;
        const Vec3 normal = glm::normalize(std::cos(angle) * x + std::sin(angle) * y);
        add_vertex(strokes, ends.first, normal, radius);
        add_vertex(strokes, ends.second, normal, radius);
    }
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const std::uint32_t a = first + 2 * i;
        const std::uint32_t b = first + 2 * ((i + 1) % kSides);
        strokes.indices.insert(strokes.indices.end(), {a, b, a + 1, b, b + 1, a + 1});
    }
}

}  // namespace

Strokes make_strokes(
    std::span<const Vec3> positions, std::span<const std::uint32_t> list, std::int32_t mode) {
    const std::size_t count = list.size();
    Strokes strokes;
    strokes.found = mode == kGltfPoints     ? count
                    : mode == kGltfLines    ? count / 2
                    : count < 2             ? 0
                    : mode == kGltfLineLoop ? count
                                            : count - 1;
    const float size = size_of(positions, list);
    const std::size_t drawn = std::min(strokes.found, kMaxStrokes);
    for (std::size_t k = 0; k < drawn; ++k) {
        const std::size_t i = k * strokes.found / drawn;
        if (mode == kGltfPoints && is_finite(positions[list[i]])) {
            add_point(strokes, list[i], kPointRadius * size);
        } else if (mode != kGltfPoints) {
            const std::size_t a = mode == kGltfLines ? 2 * i : i;
            add_line(strokes, positions, {list[a], list[(a + 1) % count]}, kLineRadius * size);
        }
    }
    return strokes;
}

}  // namespace limn
