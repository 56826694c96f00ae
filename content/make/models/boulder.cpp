#include "content/make/models/boulder.h"

#include "content/make/models/surface_grid.h"
#include "ecs/base/gradient_noise.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {
namespace {

/// Directions spread evenly over the sphere (Fibonacci lattice), then moved at random, over the
/// distances of the planes from the center.
std::vector<Vec3> make_planes(const BoulderShape& shape) {
    const auto seed = static_cast<std::uint32_t>(shape.seed);
    const auto random = [seed](int i, int k) {
        return static_cast<float>(lattice_hash(i, k, seed) >> 8) / 16777216.0f;
    };
    constexpr float kGoldenAngle = 2.39996323f;
    std::vector<Vec3> planes;
    for (int i = 0; i < shape.facets; ++i) {
        const float y = 1 - 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(shape.facets);
        const float across = std::sqrt(1 - y * y);
        const float angle = kGoldenAngle * static_cast<float>(i);
        const Vec3 even = {across * std::cos(angle), y, across * std::sin(angle)};
        const Vec3 shift = Vec3(random(i, 0), random(i, 1), random(i, 2)) - 0.5f;
        planes.push_back(glm::normalize(even + 0.7f * shift) / (0.78f + 0.22f * random(i, 3)));
    }
    return planes;
}

/// Distance to the surface in the direction `d`: the p-norm of its distances to the planes, which
/// rounds their edges the more the smaller p is.
float radius_toward(const BoulderShape& shape, const std::vector<Vec3>& planes, const Vec3& d) {
    const float p = 6 + 60 * square(1 - shape.wear);
    constexpr float kBall = 0.8f;  // what is left between the planes is cut by a ball
    float sum = std::pow(kBall, p);
    for (const Vec3& plane : planes) {
        sum += std::pow(std::max(glm::dot(plane, d), 0.0f), p);
    }
    const float smooth = 1 / std::pow(sum, 1 / p);
    const auto seed = static_cast<std::uint32_t>(shape.seed);
    constexpr int kOctaves = 3;
    return smooth * (1 + shape.roughness * (2 * noise(2.5f * d, seed + 7u, kOctaves) - 1));
}

}  // namespace

MeshData make_boulder(const BoulderShape& shape) {
    const std::vector<Vec3> planes = make_planes(shape);
    const auto position = [&](const Vec3& d) {
        return 0.5f * shape.size * radius_toward(shape, planes, d) * d;
    };
    MeshData mesh;
    append_grid(
        mesh, shape.segments, shape.rings, {.top = true, .bottom = true}, [&](int i, int j) {
            const float around = 2 * kPi * part(i % shape.segments, shape.segments);
            const float down = kPi * part(j, shape.rings);
            const bool pole = j == 0 || j == shape.rings;
            const Vec3 d = {
                pole ? 0 : std::sin(down) * std::sin(around), std::cos(down),
                pole ? 0 : std::sin(down) * std::cos(around)};
            const Vec3 right = {std::cos(around), 0, -std::sin(around)};
            const Vec3 up = glm::cross(d, right);
            const float step =
                0.5f * kPi / static_cast<float>(shape.rings);  // as fine as the quads
            const auto slope = [&](const Vec3& along) {
                return position(glm::normalize(d + step * along))
                       - position(glm::normalize(d - step * along));
            };
            const Vec3 to_right = slope(right);
            const Vec3 normal = normalize_or(glm::cross(to_right, slope(up)), d);
            const Vec3 tangent =
                normalize_or(to_right - normal * glm::dot(normal, to_right), right);
            return GridVertex{
                position(d), normal, tangent, {part(i, shape.segments), part(j, shape.rings)}};
        });
    return mesh;
}

}  // namespace limn
