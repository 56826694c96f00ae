#include "systems/animation/patch_normals.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

// Techniques: face.bids-surface

namespace limn {
namespace {

// Cosines between normals at markers and of triangles; by eye.
constexpr float kSteep = 0.3f;        ///< of the mean, below which the axis takes over
constexpr float kWidestUsed = 0.05f;  ///< of the axis: with wider cones, the mean is kept
constexpr float kWidestTrusted = 0.15f;
constexpr std::size_t kMaxTriangles = 24;  ///< at a marker; with more, the mean is kept

/// The least cosine of a unit vector with the others.
float least_cosine(const Vec3& axis, std::span<const Vec3> directions) {
    float least = 1.0f;
    for (const Vec3& direction : directions) {
        least = std::min(least, glm::dot(axis, direction));
    }
    return least;
}

/// The normal at a marker whose triangles turn away from their mean.
Vec3 steep_normal(const Vec3& mean, std::span<const Vec3> triangles) {
    if (triangles.size() > kMaxTriangles) {
        return mean;
    }
    const Vec3 axis = axis_of_cone(triangles);
    const auto rise = [](float value, float from, float to) {
        return std::clamp((value - from) / (to - from), 0.0f, 1.0f);
    };
    const float share = (1.0f - rise(least_cosine(mean, triangles), 0, kSteep))
                        * rise(least_cosine(axis, triangles), kWidestUsed, kWidestTrusted);
    return normalize_or(glm::mix(mean, axis, share), mean);
}

}  // namespace

Vec3 axis_of_cone(std::span<const Vec3> directions) {
    Vec3 best(0);
    float widest = -INFINITY;
    const auto try_axis = [&](const Vec3& candidate) {
        const Vec3 axis = normalize_or(candidate, Vec3(0));
        const float least = least_cosine(axis, directions);
        if (axis != Vec3(0) && least > widest) {
            widest = least;
            best = axis;
        }
    };
    // The smallest cone touches two of them, or three.
    for (std::size_t i = 0; i < directions.size(); ++i) {
        try_axis(directions[i]);
        for (std::size_t j = 0; j < i; ++j) {
            try_axis(directions[i] + directions[j]);
            for (std::size_t k = 0; k < j; ++k) {
                const Vec3 axis =
                    glm::cross(directions[i] - directions[k], directions[j] - directions[k]);
                try_axis(axis);
                try_axis(-axis);
            }
        }
    }
    return best;
}

void make_patch_normals(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::vector<Vec3>& normals) {
    // Reused from step to step.
    thread_local std::vector<Vec3> faces;
    thread_local std::vector<bool> steep;
    thread_local std::vector<std::pair<std::uint32_t, std::uint32_t>> turned;  // marker, face
    thread_local std::vector<Vec3> around;
    const std::size_t count = corners.size() / 3;
    normals.assign(positions.size(), Vec3(0));
    faces.resize(count);
    for (std::size_t f = 0; f < count; ++f) {
        const Vec3 a = positions[corners[3 * f]];
        const Vec3 area =
            glm::cross(positions[corners[3 * f + 1]] - a, positions[corners[3 * f + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) {
            normals[corners[3 * f + k]] += area;
        }
        faces[f] = normalize_or(area, Vec3(0));
    }
    for (Vec3& normal : normals) {
        normal = normalize_or(normal, Vec3(0, 0, 1));
    }
    steep.assign(positions.size(), false);
    const auto has_area = [&](std::size_t f) { return faces[f] != Vec3(0); };
    for (std::size_t i = 0; i < 3 * count; ++i) {
        if (has_area(i / 3) && glm::dot(faces[i / 3], normals[corners[i]]) < kSteep) {
            steep[corners[i]] = true;
        }
    }
    turned.clear();
    for (std::size_t i = 0; i < 3 * count; ++i) {
        if (steep[corners[i]] && has_area(i / 3)) {
            turned.emplace_back(corners[i], static_cast<std::uint32_t>(i / 3));
        }
    }
    std::sort(turned.begin(), turned.end());
    for (std::size_t first = 0, i = 0; i < turned.size(); ++i) {
        const std::uint32_t marker = turned[i].first;
        if (i + 1 == turned.size() || turned[i + 1].first != marker) {
            around.clear();
            for (; first <= i; ++first) {
                around.push_back(faces[turned[first].second]);
            }
            normals[marker] = steep_normal(normals[marker], around);
        }
    }
}

}  // namespace limn
