#include "render/geometry/mesh_curvature.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

// Techniques: relief.curvature-fit, relief.mapping-scale, relief.quadric-class,
//     relief.vertex-format

namespace limn {
namespace {

/// The first vertex with the same position and normal, for each vertex: seams of the texture are
/// welded, hard edges are not.
std::vector<std::uint32_t> weld_seams(const MeshData& mesh) {
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const Vec3& p = mesh.positions[a];
        const Vec3& q = mesh.positions[b];
        const Vec3& m = mesh.normals[a];
        const Vec3& n = mesh.normals[b];
        return std::tie(p.x, p.y, p.z, m.x, m.y, m.z, a)
               < std::tie(q.x, q.y, q.z, n.x, n.y, n.z, b);
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<std::uint32_t> first(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::uint32_t previous = order[i > 0 ? i - 1 : 0];
        const bool is_same = i > 0 && mesh.positions[order[i]] == mesh.positions[previous]
                             && mesh.normals[order[i]] == mesh.normals[previous];
        first[order[i]] = is_same ? first[previous] : order[i];
    }
    return first;
}

/// Edges of welded vertices, both ways, sorted by their first.
using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Edges welded_edges(const MeshData& mesh, std::span<const std::uint32_t> first) {
    Edges edges;
    edges.reserve(2 * mesh.indices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = first[mesh.indices[i + k]];
            const std::uint32_t b = first[mesh.indices[i + (k + 1) % 3]];
            if (a != b) {
                edges.emplace_back(a, b);
                edges.emplace_back(b, a);
            }
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

}  // namespace

std::vector<Vec2> mapping_scales(const MeshData& mesh) {
    std::vector<Vec2> sums(mesh.positions.size(), Vec2(0));
    std::vector<float> counts(mesh.positions.size(), 0.0f);
    for (std::size_t i = 0; i + 2 < mesh.indices.size() && !mesh.uvs.empty(); i += 3) {
        const std::uint32_t* const t = &mesh.indices[i];
        const Vec3 e1 = mesh.positions[t[1]] - mesh.positions[t[0]];
        const Vec3 e2 = mesh.positions[t[2]] - mesh.positions[t[0]];
        const Vec2 d1 = mesh.uvs[t[1]] - mesh.uvs[t[0]];
        const Vec2 d2 = mesh.uvs[t[2]] - mesh.uvs[t[0]];
        const float area = d1.x * d2.y - d2.x * d1.y;
        if (std::abs(area) <= 1e-12f) {
            continue;
        }
        const Vec2 scale = {
            glm::length(e1 * d2.y - e2 * d1.y) / std::abs(area),
            glm::length(e2 * d1.x - e1 * d2.x) / std::abs(area)};
        for (std::size_t k = 0; k < 3; ++k) {
            sums[t[k]] += scale;
            counts[t[k]] += 1;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] /= std::max(counts[i], 1.0f);
    }
    return sums;
}

Vec2 fit_quadric(const std::vector<Vec3>& neighbors) {
    constexpr double kSingular = 1e-6;  // of the determinant, to the squared trace
    if (neighbors.size() < 3) {
        return Vec2(0);
    }
    double xx = 0;
    double xy = 0;
    double yy = 0;
    glm::dvec2 fall(0);
    for (const Vec3& p : neighbors) {
        const double x2 = double(p.x) * double(p.x);
        const double y2 = double(p.y) * double(p.y);
        xx += x2 * x2;
        xy += x2 * y2;
        yy += y2 * y2;
        fall -= glm::dvec2(x2, y2) * double(p.z);
    }
    const double determinant = xx * yy - xy * xy;
    const double trace = xx + yy;
    if (trace <= 0) {
        return Vec2(0);
    }
    if (determinant > kSingular * trace * trace) {
        return Vec2((glm::dvec2(yy, xx) * fall - xy * glm::dvec2(fall.y, fall.x)) / determinant);
    }
    // All neighbors on two lines: the fit of least norm. The matrix is trace * a a^T, |a| = 1.
    const glm::dvec2 a = glm::normalize(glm::dvec2(std::sqrt(xx), std::sqrt(yy)));
    return Vec2(a * (glm::dot(a, fall) / trace));
}

std::vector<Vec2> fit_curvatures(const MeshData& mesh) {
    std::vector<Vec2> curvatures(mesh.positions.size(), Vec2(0));
    if (mesh.tangents.size() != mesh.positions.size()
        || mesh.normals.size() != mesh.positions.size()) {
        return curvatures;
    }
    const std::vector<std::uint32_t> first = weld_seams(mesh);
    const Edges edges = welded_edges(mesh, first);
    std::vector<Vec3> ring;
    for (std::size_t i = 0; i < curvatures.size(); ++i) {
        const Vec3 normal = mesh.normals[i];
        const Vec3 tangent = Vec3(mesh.tangents[i]);
        const Vec3 bitangent = glm::cross(normal, tangent) * mesh.tangents[i].w;
        ring.clear();
        auto edge = std::lower_bound(edges.begin(), edges.end(), std::pair(first[i], 0u));
        for (; edge != edges.end() && edge->first == first[i]; ++edge) {
            const Vec3 to = mesh.positions[edge->second] - mesh.positions[i];
            ring.emplace_back(glm::dot(to, tangent), glm::dot(to, bitangent), glm::dot(to, normal));
        }
        curvatures[i] = fit_quadric(ring);
    }
    return curvatures;
}

QuadricClass quadric_class(const Vec2& curvature, float zero) {
    const bool flat_x = std::abs(curvature.x) <= zero;
    const bool flat_y = std::abs(curvature.y) <= zero;
    if (flat_x && flat_y) {
        return QuadricClass::Plane;
    }
    if (flat_x || flat_y) {
        return QuadricClass::Cylinder;
    }
    return (curvature.x > 0) == (curvature.y > 0) ? QuadricClass::Paraboloid : QuadricClass::Saddle;
}

}  // namespace limn
