#include "systems/animation/surface_patches.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "systems/animation/patch_normals.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>

// Techniques: face.bids-rebuild, face.bids-surface

namespace limn {
namespace {

constexpr float kMinPatchShape = 1e-6f;    ///< area of a triangle over its longest edge squared
constexpr float kMinPatchNormal = 1e-20f;  ///< squared length of a sum of normals that has none
constexpr float kMinCorner = 1e-12f;       ///< 1 - weight of a corner, at that corner

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Two thirds from `b` to `a`, projected into the plane through `a`.
Vec3 edge_point(const Vec3& a, const Vec3& b, const Vec3& normal_a) {
    return (2.0f * a + b - glm::dot(b - a, normal_a) * normal_a) / 3.0f;
}

/// What bends a cubic patch so that it meets the tangent planes of the boundary from p[0] to p[1],
/// at either end: the inner points of a Gregory patch less those of the cubic. The direction across
/// the boundary is lambda W + mu A there, where W is the tangent of the boundary, A a quadratic
/// field that depends on the boundary and its normals alone, and lambda and mu are linear.
/// `edge`: inner control points of the boundary, from p[0]; `near`: of the two other boundaries, by
/// p[0] and by p[1]; `n`: normals at p[0] and p[1].
std::array<Vec3, 2> bend_to_edge(
    const std::array<Vec3, 2>& p, const std::array<Vec3, 2>& edge, const std::array<Vec3, 2>& near,
    const std::array<Vec3, 2>& n, const Vec3& inner) {
    const std::array<Vec3, 3> w = {edge[0] - p[0], edge[1] - edge[0], p[1] - edge[1]};
    const Vec3 first = normalize_or(glm::cross(n[0], w[0]), any_perpendicular(n[0]));
    const Vec3 last = normalize_or(glm::cross(n[1], w[2]), any_perpendicular(n[1]));
    const std::array<Vec3, 3> a = {first, normalize_or(first + last, first), last};
    // Across the boundary at its ends, of the patch raised to degree four.
    const Vec3 d0 = (p[0] + 3.0f * near[0]) / 4.0f - (5.0f * p[0] + 3.0f * edge[0]) / 8.0f;
    const Vec3 d1 = (p[1] + 3.0f * near[1]) / 4.0f - (5.0f * p[1] + 3.0f * edge[1]) / 8.0f;
    const auto share = [](const Vec3& d, const Vec3& along) {
        const float length2 = glm::dot(along, along);
        return length2 > 0.0f ? glm::dot(d, along) / length2 : 0.0f;
    };
    const std::array<float, 2> lambda = {share(d0, w[0]), share(d1, w[2])};
    const std::array<float, 2> mu = {glm::dot(d0, a[0]), glm::dot(d1, a[2])};
    const std::array<Vec3, 3> raised = {
        (p[0] + 3.0f * edge[0]) / 4.0f, (edge[0] + edge[1]) / 2.0f, (3.0f * edge[1] + p[1]) / 4.0f};
    const auto product = [](float l, const Vec3& x, float m, const Vec3& y) {
        return (l * x + m * y) / 3.0f;
    };
    const Vec3 bend0 = (raised[0] + raised[1]) / 2.0f
                       + product(2.0f * lambda[0], w[1], lambda[1], w[0])
                       + product(2.0f * mu[0], a[1], mu[1], a[0]);
    const Vec3 bend1 = (raised[1] + raised[2]) / 2.0f
                       + product(lambda[0], w[2], 2.0f * lambda[1], w[1])
                       + product(mu[0], a[2], 2.0f * mu[1], a[1]);
    return {
        bend0 - (2.0f * inner + edge[0] + near[0]) / 4.0f,
        bend1 - (2.0f * inner + edge[1] + near[1]) / 4.0f};
}

/// Normal at the midpoint of an edge.
Vec3 edge_normal(const Vec3& a, const Vec3& b, const Vec3& normal_a, const Vec3& normal_b) {
    const Vec3 along = b - a;
    const float length2 = glm::dot(along, along);
    const Vec3 sum = normal_a + normal_b;
    const float scale = length2 > 0.0f ? 2.0f * glm::dot(along, sum) / length2 : 0.0f;
    return normalize_or(sum - scale * along, normal_a);
}

/// Adds the offsets, each 12 c^2 a^2 b / (a + b) times, where c + a + b = 1: in an edge, b = 0,
/// that has no value and the slope of a quartic by b. Derivatives by u and v are those by the three
/// coordinates, less that by w.
void add_bends(std::span<const Vec4> patch, const Vec3& barycentric, PatchPoint& at) {
    for (int edge = 0; edge < 3; ++edge) {
        for (int end = 0; end < 2; ++end) {
            const int corner = (edge + end) % 3;
            const int other = (edge + 1 - end) % 3;
            const int inward = (edge + 2) % 3;
            const float c = barycentric[corner];
            const float a = barycentric[other];
            const float b = barycentric[inward];
            // Outside of the triangle the share does not grow.
            const float share = a + b > kMinCorner ? std::clamp(a / (a + b), 0.0f, 1.0f) : 0.5f;
            Vec3 by;
            by[corner] = 24.0f * c * a * b * share;
            by[other] = 12.0f * c * c * b * share * (2.0f - share);
            by[inward] = 12.0f * c * c * a * share * share;
            const Vec3 offset =
                Vec3(patch[kPatchPoints + static_cast<std::size_t>(2 * edge + end)]);
            at.position += 12.0f * c * c * a * b * share * offset;
            at.by_u += (by[0] - by[2]) * offset;
            at.by_v += (by[1] - by[2]) * offset;
        }
    }
}

}  // namespace

Result<PatchFaces> make_patch_faces(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const std::uint64_t> kinds) {
    LIMN_CHECK(kinds.empty() || kinds.size() == positions.size());
    std::map<std::tuple<float, float, float, std::uint64_t>, std::uint32_t> first;
    PatchFaces faces;
    std::map<Edge, int> edges;  // directed
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        std::array<std::uint32_t, 3> face{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = indices[i + k];
            const Vec3 p = positions[v];
            const std::uint64_t kind = kinds.empty() ? 0 : kinds[v];
            face[k] = first.try_emplace({p.x, p.y, p.z, kind}, v).first->second;
        }
        if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) {
            continue;
        }
        const Vec3 ab = positions[face[1]] - positions[face[0]];
        const Vec3 ac = positions[face[2]] - positions[face[0]];
        const float longest = std::max({glm::length(ab), glm::length(ac), glm::length(ac - ab)});
        if (!(glm::length(glm::cross(ab, ac)) > kMinPatchShape * square(longest))) {
            return fail("triangle {} has no area", i / 3);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge edge = {face[k], face[(k + 1) % 3]};
            const int others = edges[{edge.second, edge.first}];
            if (++edges[edge] > 1) {
                return fail(
                    "triangle {} shares the edge of vertices {} and {} with {}", i / 3, edge.first,
                    edge.second,
                    others > 0 ? "two others, expected one"
                               : "one that faces the opposite side or is the same");
            }
        }
        faces.corners.insert(faces.corners.end(), face.begin(), face.end());
        faces.named.insert(faces.named.end(), {indices[i], indices[i + 1], indices[i + 2]});
    }
    if (faces.corners.empty()) {
        return fail("it has no triangles");
    }
    return faces;
}

void make_patches(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::vector<Vec4>& patches) {
    thread_local std::vector<Vec3> normals;  // reused from step to step
    make_patch_normals(positions, corners, normals);
    patches.resize(corners.size() / 3 * kPatchTexels);
    for (std::size_t f = 0; f < corners.size() / 3; ++f) {
        std::array<Vec3, 3> p{};
        std::array<Vec3, 3> n{};
        for (std::size_t k = 0; k < 3; ++k) {
            p[k] = positions[corners[3 * f + k]];
            n[k] = normals[corners[3 * f + k]];
        }
        const std::array<Vec3, 6> edge = {
            edge_point(p[0], p[1], n[0]), edge_point(p[1], p[0], n[1]),
            edge_point(p[1], p[2], n[1]), edge_point(p[2], p[1], n[2]),
            edge_point(p[2], p[0], n[2]), edge_point(p[0], p[2], n[0])};
        const Vec3 mean = (edge[0] + edge[1] + edge[2] + edge[3] + edge[4] + edge[5]) / 6.0f;
        const Vec3 inner = mean + 0.5f * (mean - (p[0] + p[1] + p[2]) / 3.0f);
        std::array<Vec3, kPatchTexels> all = {p[0],    p[1],    p[2],    edge[0], edge[1],
                                              edge[2], edge[3], edge[4], edge[5], inner};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            const std::array<Vec3, 2> bends = bend_to_edge(
                {p[k], p[next]}, {edge[2 * k], edge[2 * k + 1]},
                {edge[(2 * k + 5) % 6], edge[2 * next]}, {n[k], n[next]}, inner);
            all[kPatchPoints + 2 * k] = bends[0];
            all[kPatchPoints + 2 * k + 1] = bends[1];
            all[kPatchNormals + k] = n[k];
            all[kPatchNormals + 3 + k] = edge_normal(p[k], p[next], n[k], n[next]);
        }
        for (std::size_t i = 0; i < kPatchTexels; ++i) {
            patches[f * kPatchTexels + i] = Vec4(all[i], 0);
        }
    }
}

PatchPoint evaluate_patch(std::span<const Vec4> patch, float u, float v) {
    const float w = 1.0f - u - v;
    const auto b = [&](std::size_t i) { return Vec3(patch[i]); };
    // The quadratic Bezier triangles whose difference is the derivative: de Casteljau's first step.
    const auto step = [&](std::size_t uu, std::size_t vv, std::size_t ww) {
        return std::array<Vec3, 3>{b(uu), b(vv), b(ww)};
    };
    const auto mix = [&](const std::array<Vec3, 3>& p) { return u * p[0] + v * p[1] + w * p[2]; };
    const Vec3 q200 = mix(step(0, 3, 8));
    const Vec3 q020 = mix(step(4, 1, 5));
    const Vec3 q002 = mix(step(7, 6, 2));
    const Vec3 q110 = mix(step(3, 4, 9));
    const Vec3 q011 = mix(step(9, 5, 6));
    const Vec3 q101 = mix(step(8, 9, 7));
    const Vec3 r100 = mix({q200, q110, q101});
    const Vec3 r010 = mix({q110, q020, q011});
    const Vec3 r001 = mix({q101, q011, q002});

    PatchPoint at{};
    at.position = mix({r100, r010, r001});
    at.by_u = 3.0f * (r100 - r001);
    at.by_v = 3.0f * (r010 - r001);
    add_bends(patch, {u, v, w}, at);

    const Vec3 m100 = mix(step(16, 19, 21));
    const Vec3 m010 = mix(step(19, 17, 20));
    const Vec3 m001 = mix(step(21, 20, 18));
    const Vec3 sum = mix({m100, m010, m001});
    const float length2 = glm::dot(sum, sum);
    if (!(length2 > kMinPatchNormal)) {
        at.normal = normalize_or(glm::cross(at.by_u, at.by_v), Vec3(0, 0, 1));
        return at;
    }
    const float inverse = 1.0f / std::sqrt(length2);
    at.normal = inverse * sum;
    const auto turned = [&](const Vec3& by) {
        return inverse * (by - glm::dot(by, at.normal) * at.normal);
    };
    at.normal_by_u = turned(2.0f * (m100 - m001));
    at.normal_by_v = turned(2.0f * (m010 - m001));
    return at;
}

Mat3 patch_axes(const PatchPoint& at, float distance) {
    return {at.by_u + distance * at.normal_by_u, at.by_v + distance * at.normal_by_v, at.normal};
}

Mat3 patch_frame(const PatchPoint& at) {
    const Vec3 tangent = normalize_or(
        at.by_u - glm::dot(at.by_u, at.normal) * at.normal, any_perpendicular(at.normal));
    return {tangent, glm::cross(at.normal, tangent), at.normal};
}

Vec3 anchored_point(const SurfaceAnchor& anchor, std::span<const Vec4> patches) {
    const PatchPoint at = evaluate_patch(
        patches.subspan(anchor.patch * kPatchTexels, kPatchTexels), anchor.u, anchor.v);
    return at.position + patch_frame(at) * anchor.offset;
}

void follow_patches(
    std::span<const SurfaceAnchor> anchors, std::span<const Vec4> patches,
    std::span<Vec3> positions, std::span<Vec3> normals, std::span<Vec4> tangents) {
    LIMN_CHECK(anchors.size() >= positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (anchors[i].patch == kNoPatch) {
            continue;
        }
        float stays = 1.0f;
        Vec3 position(0);
        Vec3 normal(0);
        Vec3 tangent(0);
        for (std::size_t a = i;; a = anchors[a].next) {
            const SurfaceAnchor& anchor = anchors[a];
            stays -= anchor.share;
            position += anchor.share * anchored_point(anchor, patches);
            if (!normals.empty()) {
                const PatchPoint at = evaluate_patch(
                    patches.subspan(anchor.patch * kPatchTexels, kPatchTexels), anchor.u, anchor.v);
                const Mat3 axes = patch_axes(at, anchor.offset.z);
                // The inverse transpose, times the determinant.
                const Mat3 cofactors(
                    glm::cross(axes[1], axes[2]), glm::cross(axes[2], axes[0]),
                    glm::cross(axes[0], axes[1]));
                const float side = glm::dot(axes[0], cofactors[0]) < 0.0f ? -1.0f : 1.0f;
                normal +=
                    anchor.share * normalize_or(side * (cofactors * anchor.normal), normals[i]);
                tangent += anchor.share * normalize_or(axes * anchor.tangent, Vec3(tangents[i]));
            }
            if (anchor.next == 0) {
                break;
            }
        }
        positions[i] = stays * positions[i] + position;
        if (!normals.empty()) {
            normals[i] = normalize_or(stays * normals[i] + normal, normals[i]);
            tangents[i] = Vec4(
                normalize_or(stays * Vec3(tangents[i]) + tangent, Vec3(tangents[i])),
                tangents[i].w);
        }
    }
}

}  // namespace limn
