#include "systems/faces/wrinkle_measure.h"

#include "ecs/base/check.h"
#include "systems/faces/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace limn {

namespace {

/// Directions of either sign that are shorter after averaging than this have canceled.
constexpr float kMinDirection = 1e-6f;

/// A triangle at rest in the plane of its edges.
struct RestTriangle {
    Vec3 e1;
    Vec3 e2;
    Vec3 normal;       ///< unit
    float twice_area;  ///< [m^2], > 0, or not a number: has none
};

RestTriangle rest_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    RestTriangle triangle = {.e1 = b - a, .e2 = c - a, .normal = {}, .twice_area = 0};
    triangle.normal = glm::cross(triangle.e1, triangle.e2);
    triangle.twice_area = glm::length(triangle.normal);
    triangle.normal /= triangle.twice_area;
    return triangle;
}

/// Mean of three directions of either sign, in the plane of the triangle; 0 where they cancel.
Vec3 mean_direction(const std::array<Vec3, 3>& d, const Vec3& normal) {
    Vec3 sum = d[0];
    for (const int i : {1, 2}) {
        sum += glm::dot(d[i], d[0]) < 0 ? -d[i] : d[i];
    }
    sum -= normal * glm::dot(normal, sum);
    const float length = glm::length(sum);
    return length >= kMinDirection && std::isfinite(length) ? sum / length : Vec3{0, 0, 0};
}

/// `direction`, in the plane of the triangle, as x e1 + y e2.
Vec2 in_edges(const RestTriangle& triangle, const Vec3& direction) {
    return Vec2{
               glm::dot(triangle.normal, glm::cross(direction, triangle.e2)),
               glm::dot(triangle.normal, glm::cross(triangle.e1, direction))}
           / triangle.twice_area;
}

float angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Weights at the three corners, not yet normalized.
std::array<float, 3> corner_weights(const RestTriangle& triangle, WrinkleWeight weight) {
    switch (weight) {
    case WrinkleWeight::Angle: {
        const Vec3 e3 = triangle.e2 - triangle.e1;
        return {
            angle_between(triangle.e1, triangle.e2), angle_between(-triangle.e1, e3),
            angle_between(-triangle.e2, -e3)};
    }
    case WrinkleWeight::Area:
        return {triangle.twice_area, triangle.twice_area, triangle.twice_area};
    case WrinkleWeight::Uniform:
        break;
    }
    return {1, 1, 1};
}

}  // namespace

WrinkleRest make_wrinkle_rest(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const Vec3> across, WrinkleWeight weight) {
    LIMN_CHECK(across.size() == positions.size());
    struct Corner {
        std::uint32_t vertex;
        WrinkleCorner at;
    };
    WrinkleRest rest;
    std::vector<Corner> corners;
    const std::vector<std::uint32_t> welded = weld_positions(positions);
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        const std::array<std::uint32_t, 3> v = {indices[i], indices[i + 1], indices[i + 2]};
        if (std::ranges::max(v) >= positions.size()) {
            continue;
        }
        const auto first = static_cast<std::uint32_t>(rest.corners.size());
        rest.corners.insert(rest.corners.end(), v.begin(), v.end());
        rest.across.push_back({0, 0});
        const RestTriangle triangle =
            rest_triangle(positions[v[0]], positions[v[1]], positions[v[2]]);
        if (!(triangle.twice_area > 0) || !std::isfinite(triangle.twice_area)) {
            continue;
        }
        const Vec3 direction =
            mean_direction({across[v[0]], across[v[1]], across[v[2]]}, triangle.normal);
        const Vec2 coefficients = in_edges(triangle, direction);
        if (coefficients == Vec2{0, 0} || !is_finite(coefficients)) {
            continue;
        }
        rest.across.back() = coefficients;
        const std::array<float, 3> weights = corner_weights(triangle, weight);
        for (std::uint32_t k = 0; k < 3; ++k) {
            corners.push_back({welded[v[k]], {first + k, weights[k]}});
        }
    }
    std::ranges::stable_sort(corners, {}, &Corner::vertex);
    std::vector<std::size_t> begin(positions.size() + 1, 0);  // of each vertex's corners
    for (const Corner& corner : corners) {
        ++begin[corner.vertex + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());

    // Triangles of the first vertex at a position, for all that are there.
    for (const std::uint32_t vertex : welded) {
        rest.first.push_back(static_cast<std::uint32_t>(rest.around.size()));
        float sum = 0;
        for (std::size_t i = begin[vertex]; i < begin[vertex + 1]; ++i) {
            sum += corners[i].at.weight;
        }
        for (std::size_t i = begin[vertex]; i < begin[vertex + 1]; ++i) {
            rest.around.push_back({corners[i].at.corner, corners[i].at.weight / sum});
        }
    }
    rest.first.push_back(static_cast<std::uint32_t>(rest.around.size()));
    return rest;
}

void find_compression(
    const WrinkleRest& rest, std::span<const Vec3> deformed, std::span<float> ratio) {
    LIMN_CHECK(deformed.size() + 1 == rest.first.size());
    LIMN_CHECK(ratio.size() == rest.across.size());
    for (std::size_t t = 0; t < ratio.size(); ++t) {
        const Vec3& a = deformed[rest.corners[3 * t]];
        const Vec3& b = deformed[rest.corners[3 * t + 1]];
        const Vec3& c = deformed[rest.corners[3 * t + 2]];
        const Vec2& across = rest.across[t];
        const Vec3 chord = across.x * (b - a) + across.y * (c - a);
        const float found = glm::dot(chord, chord);
        ratio[t] = across == Vec2{0, 0} ? 1.0f : finite_or(found, 1.0f);
    }
}

void average_compression(
    const WrinkleRest& rest, std::span<const float> ratio, std::span<float> vertices) {
    LIMN_CHECK(ratio.size() == rest.across.size());
    LIMN_CHECK(vertices.size() + 1 == rest.first.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        float sum = 0;
        for (std::uint32_t i = rest.first[v]; i < rest.first[v + 1]; ++i) {
            sum += rest.around[i].weight * ratio[rest.around[i].corner / 3];
        }
        vertices[v] = rest.first[v] == rest.first[v + 1] ? 1.0f : sum;
    }
}

float wrinkle_intensity(float ratio, float lambda, float beta) {
    // As a hyperbolic tangent, which does not overflow; log(0) = -infinity gives 1.
    return -std::tanh(0.5f * beta * std::log(lambda * std::max(ratio, 0.0f)));
}

}  // namespace limn
