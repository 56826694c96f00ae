#include "content/bake/furrow_field.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

// Techniques: wrinkle.furrow.field-init, wrinkle.furrow.field-interpolate

namespace limn {
namespace {

constexpr float kMaxMagnitude = 2.0f;

/// `v` rotated into the plane of unit `n`, with its length; 0 if it is parallel to `n`.
Vec3 turned_tangent(const Vec3& v, const Vec3& n) {
    return std::min(glm::length(v), kMaxMagnitude) * normalize_or(v - glm::dot(v, n) * n, Vec3(0));
}

FurrowVectors turned_tangent(const FurrowVectors& vectors, const Vec3& n) {
    return {turned_tangent(vectors[0], n), turned_tangent(vectors[1], n)};
}

}  // namespace

FurrowVectors initial_furrow_vectors(const Vec3& n) {
    const auto projected = [&n](const Vec3& axis) { return axis - n * glm::dot(axis, n); };
    Vec3 up = projected({0, 1, 0});
    if (glm::dot(up, up) < 1e-10f) {
        up = projected({0, 0, -1});
    }
    return {up, glm::cross(up, n)};
}

std::vector<FurrowEdit> place_furrow_arrows(
    std::span<const FurrowArrow> arrows, std::span<const Vec3> positions,
    std::span<const Vec3> normals) {
    std::vector<FurrowEdit> edits;
    if (positions.empty()) {
        return edits;
    }
    for (const FurrowArrow& arrow : arrows) {
        std::uint32_t nearest = 0;
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            const Vec3 offset = positions[i] - arrow.at;
            if (const float distance2 = glm::dot(offset, offset); distance2 < least) {
                least = distance2;
                nearest = i;
            }
        }
        edits.push_back(
            {nearest, turned_tangent({arrow.first, arrow.second}, normals[nearest]), arrow.weight});
    }
    return edits;
}

FurrowVectors interpolate_furrow_vectors(
    const Vec3& point, std::span<const FurrowEdit> edits, std::span<const Vec3> positions,
    const FurrowVectors& otherwise) {
    float total = 0;
    FurrowVectors sum = {Vec3(0), Vec3(0)};
    for (const FurrowEdit& edit : edits) {
        if (!(edit.weight > 0)) {
            continue;
        }
        const float distance = glm::distance(point, positions[edit.vertex]);
        if (distance == 0) {
            return edit.vectors;
        }
        const float weight = edit.weight / distance;
        total += weight;
        sum[0] += weight * edit.vectors[0];
        sum[1] += weight * edit.vectors[1];
    }
    if (!(total > 0) || !std::isfinite(total)) {
        return otherwise;
    }
    return {sum[0] / total, sum[1] / total};
}

std::vector<FurrowVectors> make_furrow_field(
    std::span<const Vec3> positions, std::span<const Vec3> normals,
    std::span<const FurrowEdit> edits) {
    LIMN_CHECK(positions.size() == normals.size());
    for (const FurrowEdit& edit : edits) {
        LIMN_CHECK(edit.vertex < positions.size());
    }
    std::vector<FurrowVectors> field(positions.size());
    parallel_for(positions.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const FurrowVectors initial = initial_furrow_vectors(normals[i]);
            const FurrowVectors found =
                interpolate_furrow_vectors(positions[i], edits, positions, initial);
            field[i] = edits.empty() ? initial : turned_tangent(found, normals[i]);
        }
    });
    return field;
}

}  // namespace limn
