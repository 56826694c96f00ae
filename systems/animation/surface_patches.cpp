#include "systems/animation/surface_patches.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"
#include "ecs/base/triangle.h"
#include "systems/animation/patch_normals.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
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
constexpr float kMinCorner = 1e-12f;       ///< 1 - weight of a corner, at that corner

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
            if (borders_.back()) {
                const Edge edge = edge_at(i);
                border_corners_.insert({edge.first, edge.second});
            }
        }
    }

    [[nodiscard]] SurfaceAnchor
    bind(const Vec3& point, const Vec3& normal, const Vec3& tangent) const {
        const auto in_space = [&](std::size_t i) { return corner(i); };
        const Faces near = nearest_faces(point, kCandidates, in_space);
        const Faces facing = facing_along(near, normal);
        SurfaceAnchor chosen;
        bool chosen_border = false;
        for (const Faces& faces : {facing, near}) {
            SurfaceAnchor anchor;
            SurfaceAnchor beside;
            bool at_border = false;
            find_inside(point, faces, anchor);
            find_beside(point, faces, at_border, beside);
            if (beside.patch != kNoPatch
                && (anchor.patch == kNoPatch
                    || glm::length(beside.offset) < glm::length(anchor.offset))) {
                anchor = beside;
            } else {
                at_border = false;
            }
            if (anchor.patch == kNoPatch) {
                continue;
            }
            const float clearly = kFacing * size_of(anchor.patch);
            if (chosen.patch == kNoPatch
                || glm::length(chosen.offset) > glm::length(anchor.offset) + clearly) {
                chosen = anchor;
                chosen_border = at_border;
            }
        }
        if (chosen.patch == kNoPatch) {
            return {};
        }
        chosen.share = share_of(chosen.offset, chosen_border);
        return finished(chosen, normal, tangent);
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
            bool at_border = false;
            const bool covered =
                (anchor.patch != kNoPatch
                 || (find_beside(point, {near[0]}, at_border, anchor) && !at_border))
                && glm::length(anchor.offset) < kCloseTo * size_of(anchor.patch);
            return covered ? finished(anchor, normal, tangent) : SurfaceAnchor{};
        }
        bool at_border = false;
        const bool found = anchor.patch != kNoPatch
                           || (find_beside(point, {near[0]}, at_border, anchor) && !at_border);
        return found ? finished(anchor, normal, tangent) : SurfaceAnchor{};
    }

  private:
    static constexpr float kOnChart = 1e-5f;
    static constexpr float kFacing =
        0.25f;  // of the size of a patch: one that faces away is nearer
    static constexpr float kCloseTo = 0.25f;  // of the size of a patch

    /// Faces, with the distances of their flat triangles.
    using Faces = std::vector<std::pair<float, std::uint32_t>>;

    /// The share of the motion at an offset: all within half the largest distance, none at it;
    /// beside the surface it fades out from the border.
    [[nodiscard]] float share_of(const Vec3& offset, bool at_border) const {
        if (!(max_distance_ > 0.0f)) {
            return 1.0f;
        }
        float share = 1.0f - smooth(2.0f * glm::length(offset) / max_distance_ - 1.0f);
        if (at_border) {
            share *= 1.0f - smooth(std::hypot(offset.x, offset.y) / max_distance_);
        }
        return std::round(255.0f * share) / 255.0f;
    }
    static float smooth(float t) {
        const float s = std::clamp(t, 0.0f, 1.0f);
        return s * s * (3.0f - 2.0f * s);
    }

    /// Adds normal and tangent, or returns an unbound anchor.
    [[nodiscard]] SurfaceAnchor
    finished(SurfaceAnchor anchor, const Vec3& normal, const Vec3& tangent) const {
        if (glm::length(anchor.offset) > max_distance_ || !(anchor.share > 0.0f)) {
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

    /// The nearest point of a patch to `p`, whose foot, if it has one, is at `at`, in or beside the
    /// triangle: then on the edges beyond which that lies.
    static Vec2 nearest_beside(std::span<const Vec4> patch, const Vec3& p, const Vec3& at) {
        const bool has_foot = is_finite(at);
        if (has_foot && is_inside_chart(at)) {
            return clamp_uvd(at);
        }
        const Vec3 foot = has_foot ? Vec3(at.x, at.y, 1.0f - at.x - at.y) : Vec3(-1);
        Vec2 nearest(1.0f / 3.0f);
        float least = INFINITY;
        for (int across = 0; across < 3; ++across) {
            if (foot[across] > 0.0f) {
                continue;
            }
            const auto point = [&](float t) {
                Vec3 weights(0);
                weights[(across + 1) % 3] = 1.0f - t;
                weights[(across + 2) % 3] = t;
                return Vec2(weights);
            };
            const auto distance = [&](float t) {
                const Vec2 uv = point(t);
                return glm::distance(evaluate_patch(patch, uv.x, uv.y).position, p);
            };
            constexpr std::array<float, 5> kOnEdge = {0, 0.25f, 0.5f, 0.75f, 1};
            const float best = *std::ranges::min_element(kOnEdge, {}, distance);
            float low = std::max(best - 0.25f, 0.0f);
            float high = std::min(best + 0.25f, 1.0f);
            for (int i = 0; i < 12; ++i) {  // ternary search
                const float third = (high - low) / 3.0f;
                if (distance(low + third) < distance(high - third)) {
                    high -= third;
                } else {
                    low += third;
                }
            }
            const std::array<float, 3> ends = {(low + high) / 2.0f, low, high};
            const float t = *std::ranges::min_element(ends, {}, distance);
            if (distance(t) < least) {
                least = distance(t);
                nearest = point(t);
            }
        }
        return nearest;
    }

    /// Above an edge: the nearest anchor, an offset that is not only along the normal, and whether
    /// that is at the border of the surface.
    bool
    find_beside(const Vec3& p, const Faces& faces, bool& is_border, SurfaceAnchor& anchor) const {
        anchor = {};
        float nearest = INFINITY;
        is_border = false;
        for (const auto& [flat, f] : faces) {
            if (flat - 0.5f * size_of(f) > nearest) {  // a patch bulges less than its size
                continue;
            }
            Vec3 at = nearest_sample(patch(f), p);
            solve_uvd(patch(f), p, size_of(f), at);
            const Vec2 clamped = nearest_beside(patch(f), p, at);
            const PatchPoint on = evaluate_patch(patch(f), clamped.x, clamped.y);
            const float distance = glm::distance(on.position, p);
            if (distance < nearest) {
                nearest = distance;
                anchor.patch = f;
                anchor.u = clamped.x;
                anchor.v = clamped.y;
                anchor.offset = glm::transpose(frame_at(on)) * (p - on.position);
                const float w = 1.0f - clamped.x - clamped.y;
                const Vec3 weights(clamped, w);
                is_border = (borders_[3 * f] && w <= kInside)
                            || (borders_[3 * f + 1] && clamped.x <= kInside)
                            || (borders_[3 * f + 2] && clamped.y <= kInside);
                for (std::size_t k = 0; k < 3; ++k) {  // all of the corner's patches see it alike
                    is_border = is_border
                                || (weights[static_cast<int>(k)] >= 1.0f - kInside
                                    && border_corners_.contains(corners_[3 * f + k]));
                }
            }
        }
        return anchor.patch != kNoPatch;
    }

    std::span<const Vec3> positions_;
    std::span<const std::uint32_t> corners_;
    float max_distance_;
    std::span<const Vec2> chart_;  ///< per corner, or empty
    std::vector<Vec4> patches_;
    std::vector<bool> borders_;  ///< of the edge from each corner to the next
    std::set<std::uint32_t> border_corners_;
};

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
        positions[i] = glm::mix(positions[i], anchored_point(at, anchor.offset), anchor.share);
        if (normals.empty()) {
            continue;
        }
        const Mat3 axes = axes_at(at, anchor.offset.z);
        // The inverse transpose, times the determinant.
        const Mat3 cofactors(
            glm::cross(axes[1], axes[2]), glm::cross(axes[2], axes[0]),
            glm::cross(axes[0], axes[1]));
        const float side = glm::dot(axes[0], cofactors[0]) < 0.0f ? -1.0f : 1.0f;
        const auto turn = [&](const Vec3& from, const Vec3& to) {
            return normalize_or(glm::mix(from, normalize_or(to, from), anchor.share), from);
        };
        normals[i] = turn(normals[i], side * (cofactors * anchor.normal));
        tangents[i] = Vec4(turn(Vec3(tangents[i]), axes * anchor.tangent), tangents[i].w);
    }
}

}  // namespace limn
