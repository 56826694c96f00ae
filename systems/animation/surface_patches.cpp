#include "systems/animation/surface_patches.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"
#include "ecs/base/triangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <utility>

// Techniques: face.bids-project, face.bids-rebuild, face.bids-surface

namespace limn {
namespace {

constexpr std::size_t kPatchGrain = 64;  ///< points per task
constexpr std::size_t kCandidates = 24;  ///< patches that are tried for a point
constexpr std::size_t kNeighbors = 8;    ///< likewise with a chart
constexpr int kSamples = 8;              ///< per edge of a patch, for the start of Newton's method
constexpr int kSteps = 20;               ///< of Newton's method
constexpr float kInside = 1e-4f;         ///< by which (u, v) may leave the triangle
constexpr float kMinPatchShape = 1e-6f;  ///< area of a triangle over its longest edge squared
constexpr float kMinPatchNormal = 1e-20f;  ///< squared length of a sum of normals that has none

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Third column of the map from (u, v, distance); the first two are by_u and by_v there.
Mat3 axes_at(const PatchPoint& at, float distance) {
    return {at.by_u + distance * at.normal_by_u, at.by_v + distance * at.normal_by_v, at.normal};
}

/// Tangent, bitangent and normal.
Mat3 frame_at(const PatchPoint& at) {
    const Vec3 tangent = normalize_or(
        at.by_u - glm::dot(at.by_u, at.normal) * at.normal, any_perpendicular(at.normal));
    return {tangent, glm::cross(at.normal, tangent), at.normal};
}

Vec3 anchored_point(const PatchPoint& at, const Vec3& offset) {
    return at.position + frame_at(at) * offset;
}

/// (u, v, distance) so that the surface plus distance along its normal is `p`, from a start.
/// False where the method does not converge.
bool solve_uvd(std::span<const Vec4> patch, const Vec3& p, float size, Vec3& uvd) {
    for (int i = 0; i < kSteps; ++i) {
        const PatchPoint at = evaluate_patch(patch, uvd.x, uvd.y);
        const Vec3 residual = p - (at.position + uvd.z * at.normal);
        const Mat3 axes = axes_at(at, uvd.z);
        const float volume = glm::determinant(axes);
        if (!(std::abs(volume) > 1e-6f * size * size)) {
            return false;
        }
        const Vec3 step = glm::inverse(axes) * residual;
        uvd += step;
        if (!is_finite(uvd) || std::abs(uvd.x) > 4.0f || std::abs(uvd.y) > 4.0f) {
            return false;
        }
        if (std::max(std::abs(step.x), std::abs(step.y)) < 1e-6f
            && std::abs(step.z) < 1e-6f * size) {
            return true;
        }
    }
    return false;
}

bool is_inside_chart(const Vec3& uvd) {
    return uvd.x >= -kInside && uvd.y >= -kInside && uvd.x + uvd.y <= 1.0f + kInside;
}

/// The nearest point of a patch among samples, as (u, v, 0).
Vec3 nearest_sample(std::span<const Vec4> patch, const Vec3& p) {
    Vec3 best(0);
    float nearest = INFINITY;
    for (int i = 0; i <= kSamples; ++i) {
        for (int j = 0; i + j <= kSamples; ++j) {
            const Vec2 at = Vec2(i, j) / static_cast<float>(kSamples);
            const float distance = glm::distance(evaluate_patch(patch, at.x, at.y).position, p);
            if (distance < nearest) {
                nearest = distance;
                best = {at, 0};
            }
        }
    }
    return best;
}

/// (u, v) of the point of the triangle nearest to the solution outside of it.
Vec2 clamp_uvd(Vec3 uvd) {
    Vec3 weights = glm::max(Vec3(uvd.x, uvd.y, 1.0f - uvd.x - uvd.y), Vec3(0));
    weights /= weights.x + weights.y + weights.z;
    return {weights.x, weights.y};
}

class PatchBinder {
  public:
    PatchBinder(
        std::span<const Vec3> positions, std::span<const std::uint32_t> corners, float max_distance,
        std::span<const Vec2> chart)
        : positions_(positions), corners_(corners), max_distance_(max_distance), chart_(chart) {
        make_patches(positions, corners, patches_);
        std::map<Edge, int> edges;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            ++edges[edge_at(i)];
        }
        for (std::size_t i = 0; i < corners.size(); ++i) {
            borders_.push_back(edges[edge_at(i)] == 1);
        }
    }

    [[nodiscard]] SurfaceAnchor
    bind(const Vec3& point, const Vec3& normal, const Vec3& tangent) const {
        const auto in_space = [&](std::size_t i) { return corner(i); };
        const Faces near = nearest_faces(point, kCandidates, in_space);
        const Faces facing = facing_along(near, normal);
        SurfaceAnchor anchor;
        const bool found = find_inside(point, facing, anchor) || find_beside(point, facing, anchor)
                           || find_inside(point, near, anchor) || find_beside(point, near, anchor);
        return found ? finished(anchor, normal, tangent) : SurfaceAnchor{};
    }

    /// `at`: of the point in the chart.
    [[nodiscard]] SurfaceAnchor bind_by_chart(
        const Vec3& point, const Vec3& normal, const Vec3& tangent, const Vec2& at) const {
        const auto in_chart = [&](std::size_t i) { return Vec3(chart_[i], 0); };
        const Faces near = nearest_faces(Vec3(at, 0), kNeighbors, in_chart);
        SurfaceAnchor anchor;
        for (std::size_t i = 0; i < near.size() && anchor.patch == kNoPatch; ++i) {
            find_inside(point, {near[i]}, anchor);
        }
        if (!near.empty() && near[0].first > kOnChart) {
            // Points beyond the border are bound where the surface covers them closely.
            const bool covered = (anchor.patch != kNoPatch || find_beside(point, {near[0]}, anchor))
                                 && glm::length(anchor.offset) < kCloseTo * size_of(anchor.patch);
            return covered ? finished(anchor, normal, tangent) : SurfaceAnchor{};
        }
        const bool found = anchor.patch != kNoPatch || find_beside(point, {near[0]}, anchor);
        return found ? finished(anchor, normal, tangent) : SurfaceAnchor{};
    }

  private:
    static constexpr float kOnChart = 1e-5f;
    static constexpr float kCloseTo = 0.25f;  // of the size of a patch

    /// Faces, with the distances of their flat triangles.
    using Faces = std::vector<std::pair<float, std::uint32_t>>;

    /// Adds normal and tangent, or returns an unbound anchor.
    [[nodiscard]] SurfaceAnchor
    finished(SurfaceAnchor anchor, const Vec3& normal, const Vec3& tangent) const {
        if (glm::length(anchor.offset) > max_distance_) {
            return {};
        }
        const PatchPoint at = evaluate_patch(patch(anchor.patch), anchor.u, anchor.v);
        const Mat3 axes = axes_at(at, anchor.offset.z);
        if (!(std::abs(glm::determinant(axes)) > 0.0f)) {
            return {};
        }
        anchor.normal = glm::transpose(axes) * normal;
        anchor.tangent = glm::inverse(axes) * tangent;
        return anchor;
    }

    [[nodiscard]] std::span<const Vec4> patch(std::size_t f) const {
        return std::span(patches_).subspan(f * kPatchTexels, kPatchTexels);
    }
    /// From corner i of all to the next of its face.
    [[nodiscard]] Edge edge_at(std::size_t i) const {
        const std::uint32_t a = corners_[i];
        const std::uint32_t b = corners_[i % 3 == 2 ? i - 2 : i + 1];
        return {std::min(a, b), std::max(a, b)};
    }
    [[nodiscard]] Vec3 corner(std::size_t i) const { return positions_[corners_[i]]; }

    /// The nearest faces, by their flat triangles; `corner_at`: where corner i of all is.
    template <typename CornerAt>
    [[nodiscard]] Faces
    nearest_faces(const Vec3& p, std::size_t count, const CornerAt& corner_at) const {
        Faces nearest;
        for (std::uint32_t f = 0; f < corners_.size() / 3; ++f) {
            const std::size_t first = std::size_t{3} * f;
            nearest.emplace_back(
                distance_to_triangle(
                    p, corner_at(first), corner_at(first + 1), corner_at(first + 2)),
                f);
        }
        const auto kept = static_cast<std::ptrdiff_t>(std::min(count, nearest.size()));
        std::partial_sort(nearest.begin(), nearest.begin() + kept, nearest.end());
        nearest.resize(static_cast<std::size_t>(kept));
        return nearest;
    }

    /// Faces that do not face away from the normal of a point, so that each of two touching lips is
    /// bound to its own patches.
    [[nodiscard]] Faces facing_along(const Faces& faces, const Vec3& normal) const {
        Faces facing;
        for (const auto& face : faces) {
            const std::size_t f = std::size_t{3} * face.second;
            const Vec3 area = glm::cross(corner(f + 1) - corner(f), corner(f + 2) - corner(f));
            if (glm::dot(area, normal) > 0.0f) {
                facing.push_back(face);
            }
        }
        return facing;
    }

    [[nodiscard]] float size_of(std::size_t f) const {
        return std::max(
            glm::distance(corner(3 * f), corner(3 * f + 1)),
            glm::distance(corner(3 * f), corner(3 * f + 2)));
    }

    /// The nearest anchor perpendicularly below the point.
    bool find_inside(const Vec3& p, const Faces& faces, SurfaceAnchor& anchor) const {
        float nearest = INFINITY;
        for (const auto& [flat, f] : faces) {
            // A patch bulges less than its size.
            if (flat - 0.5f * size_of(f) > nearest) {
                continue;
            }
            Vec3 at = nearest_sample(patch(f), p);
            at.z = glm::dot(
                p - evaluate_patch(patch(f), at.x, at.y).position,
                evaluate_patch(patch(f), at.x, at.y).normal);
            if (solve_uvd(patch(f), p, size_of(f), at) && is_inside_chart(at)
                && std::abs(at.z) < nearest) {
                nearest = std::abs(at.z);
                anchor.patch = f;
                anchor.u = at.x;
                anchor.v = at.y;
                anchor.offset = {0, 0, at.z};
            }
        }
        return anchor.patch != kNoPatch;
    }

    /// Above an edge that is not at the border of the surface: the nearest anchor, and an offset
    /// that is not only along the normal.
    bool find_beside(const Vec3& p, const Faces& faces, SurfaceAnchor& anchor) const {
        anchor = {};
        float nearest = INFINITY;
        bool is_border = false;
        for (const auto& [flat, f] : faces) {
            Vec3 at = nearest_sample(patch(f), p);
            solve_uvd(patch(f), p, size_of(f), at);
            const Vec2 clamped = is_finite(at) ? clamp_uvd(at) : Vec2(1.0f / 3.0f);
            const PatchPoint on = evaluate_patch(patch(f), clamped.x, clamped.y);
            const float distance = glm::distance(on.position, p);
            if (distance < nearest) {
                nearest = distance;
                anchor.patch = f;
                anchor.u = clamped.x;
                anchor.v = clamped.y;
                anchor.offset = glm::transpose(frame_at(on)) * (p - on.position);
                const float w = 1.0f - clamped.x - clamped.y;
                is_border = (borders_[3 * f] && w <= kInside)
                            || (borders_[3 * f + 1] && clamped.x <= kInside)
                            || (borders_[3 * f + 2] && clamped.y <= kInside);
            }
        }
        if (is_border) {
            anchor = {};
        }
        return anchor.patch != kNoPatch;
    }

    std::span<const Vec3> positions_;
    std::span<const std::uint32_t> corners_;
    float max_distance_;
    std::span<const Vec2> chart_;  ///< per corner, or empty
    std::vector<Vec4> patches_;
    std::vector<bool> borders_;  ///< of the edge from each corner to the next
};

/// Two thirds from `b` to `a`, projected into the plane through `a`.
Vec3 edge_point(const Vec3& a, const Vec3& b, const Vec3& normal_a) {
    return (2.0f * a + b - glm::dot(b - a, normal_a) * normal_a) / 3.0f;
}

/// Normal at the midpoint of an edge.
Vec3 edge_normal(const Vec3& a, const Vec3& b, const Vec3& normal_a, const Vec3& normal_b) {
    const Vec3 along = b - a;
    const float length2 = glm::dot(along, along);
    const Vec3 sum = normal_a + normal_b;
    const float scale = length2 > 0.0f ? 2.0f * glm::dot(along, sum) / length2 : 0.0f;
    return normalize_or(sum - scale * along, normal_a);
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
    normals.assign(positions.size(), Vec3(0));
    for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) {
        const Vec3 a = positions[corners[i]];
        const Vec3 area = glm::cross(positions[corners[i + 1]] - a, positions[corners[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) {
            normals[corners[i + k]] += area;
        }
    }
    for (Vec3& normal : normals) {
        normal = normalize_or(normal, Vec3(0, 0, 1));
    }
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
        const std::array<Vec3, kPatchTexels> all = {
            p[0],
            p[1],
            p[2],
            edge[0],
            edge[1],
            edge[2],
            edge[3],
            edge[4],
            edge[5],
            inner,
            n[0],
            n[1],
            n[2],
            edge_normal(p[0], p[1], n[0], n[1]),
            edge_normal(p[1], p[2], n[1], n[2]),
            edge_normal(p[2], p[0], n[2], n[0])};
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
    const Vec3 m100 = mix(step(10, 13, 15));
    const Vec3 m010 = mix(step(13, 11, 14));
    const Vec3 m001 = mix(step(15, 14, 12));
    const Vec3 sum = mix({m100, m010, m001});
    const float length2 = glm::dot(sum, sum);

    PatchPoint at{};
    at.position = mix({r100, r010, r001});
    at.by_u = 3.0f * (r100 - r001);
    at.by_v = 3.0f * (r010 - r001);
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

std::vector<SurfaceAnchor> bind_to_patches(
    std::span<const Vec3> points, std::span<const Vec3> normals, std::span<const Vec4> tangents,
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners, float max_distance,
    const PatchChart& chart) {
    LIMN_CHECK(chart.corners.empty() || chart.corners.size() == corners.size());
    const PatchBinder binder(positions, corners, max_distance, chart.corners);
    std::vector<SurfaceAnchor> anchors(points.size());
    parallel_for(points.size(), kPatchGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 tangent = Vec3(tangents[i]);
            anchors[i] =
                chart.corners.empty()
                    ? binder.bind(points[i], normals[i], tangent)
                    : binder.bind_by_chart(points[i], normals[i], tangent, chart.points[i]);
        }
    });
    return anchors;
}

void follow_patches(
    std::span<const SurfaceAnchor> anchors, std::span<const Vec4> patches,
    std::span<Vec3> positions, std::span<Vec3> normals, std::span<Vec4> tangents) {
    LIMN_CHECK(anchors.size() == positions.size());
    for (std::size_t i = 0; i < anchors.size(); ++i) {
        const SurfaceAnchor& anchor = anchors[i];
        if (anchor.patch == kNoPatch) {
            continue;
        }
        const PatchPoint at = evaluate_patch(
            patches.subspan(anchor.patch * kPatchTexels, kPatchTexels), anchor.u, anchor.v);
        positions[i] = anchored_point(at, anchor.offset);
        if (normals.empty()) {
            continue;
        }
        const Mat3 axes = axes_at(at, anchor.offset.z);
        // The inverse transpose, times the determinant.
        const Mat3 cofactors(
            glm::cross(axes[1], axes[2]), glm::cross(axes[2], axes[0]),
            glm::cross(axes[0], axes[1]));
        const float side = glm::dot(axes[0], cofactors[0]) < 0.0f ? -1.0f : 1.0f;
        normals[i] = normalize_or(side * (cofactors * anchor.normal), normals[i]);
        tangents[i] = Vec4(normalize_or(axes * anchor.tangent, Vec3(tangents[i])), tangents[i].w);
    }
}

}  // namespace limn
