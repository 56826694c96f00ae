#pragma once

#include "ecs/components/surface.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace limn::test {

// What holds for every mesh that content/make makes.

inline Vec3 corner(const MeshData& mesh, std::size_t index) {
    return mesh.positions[mesh.indices[index]];
}

/// Twice the area of a triangle, as a vector along its normal.
inline Vec3 double_area(const MeshData& mesh, std::size_t triangle) {
    const Vec3 a = corner(mesh, 3 * triangle);
    return glm::cross(corner(mesh, 3 * triangle + 1) - a, corner(mesh, 3 * triangle + 2) - a);
}

/// Lengths of arrays, unit vectors, indices in range, bounds that are exact.
inline void check_arrays(const MeshData& mesh) {
    const std::size_t count = mesh.positions.size();
    REQUIRE(count > 0);
    REQUIRE(mesh.normals.size() == count);
    REQUIRE(mesh.tangents.size() == count);
    REQUIRE(mesh.uvs.size() == count);
    REQUIRE(mesh.indices.size() % 3 == 0);
    REQUIRE(!mesh.indices.empty());
    REQUIRE(*std::max_element(mesh.indices.begin(), mesh.indices.end()) < count);
    Bounds bounds;
    float worst_length = 0;
    float worst_angle = 0;
    bool finite = true;
    bool right_handed = true;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 tangent = Vec3(mesh.tangents[i]);
        grow(bounds, mesh.positions[i]);
        worst_length = std::max(worst_length, std::abs(glm::length(mesh.normals[i]) - 1.0f));
        worst_length = std::max(worst_length, std::abs(glm::length(tangent) - 1.0f));
        worst_angle = std::max(worst_angle, std::abs(glm::dot(mesh.normals[i], tangent)));
        right_handed = right_handed && mesh.tangents[i].w == 1.0f;
        const float sum = glm::dot(mesh.positions[i], Vec3(1)) + glm::dot(mesh.normals[i], Vec3(1))
                          + glm::dot(mesh.tangents[i], Vec4(1)) + glm::dot(mesh.uvs[i], Vec2(1));
        finite = finite && std::isfinite(sum);
    }
    CHECK(finite);
    CHECK(right_handed);
    CHECK(worst_length < 1e-5f);
    CHECK(worst_angle < 1e-5f);
    CHECK(bounds.min == mesh.bounds.min);
    CHECK(bounds.max == mesh.bounds.max);
}

/// The worst cosine between a triangle's own normal and the normals of its vertices. Triangles of
/// less than a thousandth of the mean area do not count: their own normal is noise.
inline float worst_facing(const MeshData& mesh) {
    double sum = 0;
    const std::size_t triangles = mesh.indices.size() / 3;
    for (std::size_t t = 0; t < triangles; ++t) {
        sum += static_cast<double>(glm::length(double_area(mesh, t)));
    }
    const float least = static_cast<float>(1e-3 * sum / static_cast<double>(triangles));
    float worst = 1;
    for (std::size_t t = 0; t < triangles; ++t) {
        const Vec3 area = double_area(mesh, t);
        if (glm::length(area) < least) {
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 normal = mesh.normals[mesh.indices[3 * t + k]];
            worst = std::min(worst, glm::dot(glm::normalize(area), normal));
        }
    }
    return worst;
}

/// The worst cosine between the tangents and the direction in which u grows across a triangle; and
/// the same for cross(normal, tangent) and the direction in which v shrinks (the top of the image).
inline float worst_tangent(const MeshData& mesh) {
    float worst = 1;
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const std::uint32_t* i = &mesh.indices[3 * t];
        const Vec3 e1 = mesh.positions[i[1]] - mesh.positions[i[0]];
        const Vec3 e2 = mesh.positions[i[2]] - mesh.positions[i[0]];
        const Vec2 d1 = mesh.uvs[i[1]] - mesh.uvs[i[0]];
        const Vec2 d2 = mesh.uvs[i[2]] - mesh.uvs[i[0]];
        const float area = d1.x * d2.y - d1.y * d2.x;
        if (std::abs(area) < 1e-9f || glm::length(glm::cross(e1, e2)) < 1e-9f) {
            continue;
        }
        const Vec3 along_u = glm::normalize((e1 * d2.y - e2 * d1.y) / area);
        const Vec3 along_v = glm::normalize((e2 * d1.x - e1 * d2.x) / area);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 tangent = Vec3(mesh.tangents[i[k]]);
            worst = std::min(worst, glm::dot(tangent, along_u));
            worst = std::min(worst, -glm::dot(glm::cross(mesh.normals[i[k]], tangent), along_v));
        }
    }
    return worst;
}

/// Edges, by position to the bit, that do not have exactly one neighbor in the other direction;
/// triangles that are a line or a point do not count. 0 = closed. Calls found(a, b) for each.
template <typename Found>
int open_edges(const MeshData& mesh, Found&& found) {
    std::map<std::array<float, 6>, int> edges;
    const auto key = [](const Vec3& a, const Vec3& b) {
        return std::array<float, 6>{a.x + 0.0f, a.y + 0.0f, a.z + 0.0f,
                                    b.x + 0.0f, b.y + 0.0f, b.z + 0.0f};
    };
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const Vec3 p[3] = {corner(mesh, 3 * t), corner(mesh, 3 * t + 1), corner(mesh, 3 * t + 2)};
        if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[key(p[k], p[(k + 1) % 3])];
            --edges[key(p[(k + 1) % 3], p[k])];
        }
    }
    int open = 0;
    for (const auto& [e, balance] : edges) {
        if (balance > 0) {
            ++open;
            found(Vec3(e[0], e[1], e[2]), Vec3(e[3], e[4], e[5]));
        }
    }
    return open;
}
inline int open_edges(const MeshData& mesh) {
    return open_edges(mesh, [](const Vec3&, const Vec3&) {});
}

/// Directed edges, by position, of more than one triangle: 0 of a two-manifold.
inline int crowded_edges(const MeshData& mesh) {
    std::map<std::array<float, 6>, int> edges;
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        const Vec3 p[3] = {
            corner(mesh, 3 * t) + 0.0f, corner(mesh, 3 * t + 1) + 0.0f,
            corner(mesh, 3 * t + 2) + 0.0f};
        if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 a = p[k];
            const Vec3 b = p[(k + 1) % 3];
            ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
        }
    }
    return static_cast<int>(
        std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second > 1; }));
}

/// By the divergence theorem; that of a closed mesh that faces outwards is positive [m^3].
inline double signed_volume(const MeshData& mesh) {
    double volume = 0;
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        volume += static_cast<double>(glm::dot(corner(mesh, 3 * t), double_area(mesh, t))) / 6.0;
    }
    return volume;
}

inline double surface_area(const MeshData& mesh) {
    double area = 0;
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        area += 0.5 * static_cast<double>(glm::length(double_area(mesh, t)));
    }
    return area;
}

}  // namespace limn::test
