#include "content/make/models/even_triangles.h"
#include "content/make/models/implicit_mesh.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

namespace limn::even_triangles_test {
namespace {

struct Solid {
    SignedDistance distance;
    Vec3 half;  ///< of a box around it
    double area, volume;
    int euler;
    double even;  ///< mean quality: less without flips
};

Solid ball() {
    return {[](const Vec3& p) { return glm::length(p) - 1; },
            Vec3(1),
            4 * kPi,
            4.0 / 3 * kPi,
            2,
            0.9725};
}
Solid ring() {
    return {
        [](const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - 1, p.z) - 0.35f; },
        {1.35f, 1.35f, 0.35f},
        4 * square(kPi) * 0.35f,
        2 * square(kPi) * square(0.35f),
        0,
        0.9725};
}
/// From y = -1 to 1, with rounded ends.
Solid capsule() {
    constexpr float kRadius = 0.4f;
    return {
        [](const Vec3& p) {
            return glm::distance(p, {0, std::clamp(p.y, -1.0f, 1.0f), 0}) - kRadius;
        },
        {kRadius, 1 + kRadius, kRadius},
        2 * kPi * kRadius * 2 + 4 * kPi * square(kRadius),
        kPi * square(kRadius) * 2 + 4.0 / 3 * kPi * kRadius * square(kRadius),
        2,
        0.925};
}

ImplicitMesh even_mesh(const Solid& solid, int cells) {
    const float cell =
        2 * std::max({solid.half.x, solid.half.y, solid.half.z}) / static_cast<float>(cells);
    const Vec3 half = solid.half + 3 * cell;
    ImplicitMesh mesh =
        mesh_surface(solid.distance, {.box = {.min = -half, .max = half}, .cell = cell});
    even_triangles(mesh, solid.distance, cell, 6);
    return mesh;
}

struct Measured {
    int open = 0;         ///< edges without exactly one neighbor
    int euler = 0;        ///< vertices - edges + faces
    double area = 0;      ///< of all triangles
    double volume = 0;    ///< inside
    float worst = 1;      ///< quality of a triangle
    double mean = 0;      ///< quality
    float off = 0;        ///< distance of a vertex from the surface
    double shortest = 0;  ///< edge, of the mean
    float turned = 1;     ///< cosine between a normal and the gradient of the distance
};

Measured measure(const ImplicitMesh& mesh, const Solid& solid) {
    Measured m;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double edge_sum = 0;
    float shortest = 1e9f;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const auto at = [&](std::size_t k) { return mesh.positions[mesh.indices[t + k % 3]]; };
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{mesh.indices[t + k], mesh.indices[t + (k + 1) % 3]}];
            const float length = glm::distance(at(k), at(k + 1));
            edge_sum += static_cast<double>(length);
            shortest = std::min(shortest, length);
        }
        const Vec3 area = 0.5f * glm::cross(at(1) - at(0), at(2) - at(0));
        m.area += static_cast<double>(glm::length(area));
        m.volume += static_cast<double>(glm::dot(at(0), area)) / 3;
        const float quality = triangle_quality(at(0), at(1), at(2));
        m.worst = std::min(m.worst, quality);
        m.mean += static_cast<double>(quality);
    }
    for (const auto& [edge, count] : edges) {
        const auto twin = edges.find({edge.second, edge.first});
        m.open += count != 1 || twin == edges.end() || twin->second != 1 ? 1 : 0;
    }
    const double faces = static_cast<double>(mesh.indices.size()) / 3;
    m.euler = static_cast<int>(mesh.positions.size()) - static_cast<int>(edges.size() / 2)
              + static_cast<int>(mesh.indices.size() / 3);
    m.mean /= faces;
    m.shortest = static_cast<double>(shortest) / (edge_sum / (3 * faces));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        m.off = std::max(m.off, std::abs(solid.distance(mesh.positions[v])));
        m.turned = std::min(
            m.turned,
            glm::dot(mesh.normals[v], surface_normal(solid.distance, mesh.positions[v], 1e-3f)));
    }
    return m;
}

TEST_CASE("even triangles: closed, on the surface, none a sliver, at any size of cells") {
    for (const Solid& solid : {ball(), ring(), capsule()}) {
        for (const int cells : {24, 37, 64, solid.euler == 0 ? 150 : 80}) {
            CAPTURE(solid.volume);
            CAPTURE(cells);
            const Measured m = measure(even_mesh(solid, cells), solid);
            CHECK(m.open == 0);
            CHECK(m.euler == solid.euler);
            CHECK(m.worst > 0.7f);
            CHECK(m.mean > solid.even);
            CHECK(m.shortest > 0.49);
            CHECK(m.off < 1e-3f * solid.half.x);
            CHECK(m.turned > 0.99f);
        }
    }
}

TEST_CASE("even triangles: area and volume approach those of the solid with the square of a cell") {
    for (const Solid& solid : {ball(), ring(), capsule()}) {
        CAPTURE(solid.volume);
        const auto off = [&](int cells) {
            const Measured m = measure(even_mesh(solid, cells), solid);
            return Vec2(1 - m.area / solid.area, 1 - m.volume / solid.volume);
        };
        const Vec2 coarse = off(30);
        const Vec2 fine = off(60);
        for (int k = 0; k < 2; ++k) {
            CHECK(coarse[k] > 0);  // chords lie inside
            CHECK(fine[k] < 0.01f);
            CHECK(coarse[k] / fine[k] == test::near(4.0f).epsilon(0.2));
        }
    }
}

TEST_CASE("even triangles: the quality of a triangle is 1 if its sides are equal, 0 on a line") {
    CHECK(
        triangle_quality({0, 0, 0}, {1, 0, 0}, {0.5f, 0.5f * std::sqrt(3.0f), 0})
        == test::near(1.0f));
    CHECK(triangle_quality({0, 0, 0}, {1, 0, 0}, {3, 0, 0}) == test::near(0.0f));
    // Sides 3, 4, 5: 4 sqrt(3) 6 / 50.
    CHECK(triangle_quality({0, 0, 0}, {3, 0, 0}, {0, 4, 0}) == test::near(0.831384f));
}

}  // namespace
}  // namespace limn::even_triangles_test
