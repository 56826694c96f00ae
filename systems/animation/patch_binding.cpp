#include "systems/animation/patch_binding.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/triangle.h"
#include "systems/animation/marker_paths.h"
#include "systems/animation/surface_patches.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

// Techniques: face.bids-project

namespace limn {
namespace {

constexpr std::size_t kPatchGrain = 64;     ///< points per task
constexpr std::size_t kCandidates = 24;     ///< patches that are tried for a point
constexpr std::size_t kChartNeighbors = 8;  ///< likewise with a chart
constexpr std::size_t kMaxAnchors = 6;      ///< of a point
constexpr float kBlend = 2.0f;   ///< how much farther than the nearest patch others may be
constexpr float kAlone = 0.05f;  ///< distance over the mean size of patches: the nearest is alone
constexpr float kShared = 0.2f;  ///< likewise: others may be as far as kBlend says
constexpr float kEdgeSlack = 1.4f;  ///< ways along edges are not longer than straight lines by more
constexpr float kLongestWay = 2.5f;  ///< ways that are looked for, relative to straight lines
constexpr int kFootSamples = 8;      ///< per edge of a patch, for the start of Newton's method
constexpr int kNewtonSteps = 20;     ///< of Newton's method
constexpr float kInside = 1e-4f;     ///< by which (u, v) may leave the triangle
constexpr float kOnChart = 1e-5f;    ///< distance from a triangle of the chart
constexpr float kFacingAway =
    0.25f;                          ///< by how much of its size a patch that faces away is farther
constexpr float kCloseTo = 0.25f;   ///< of the size of a patch
constexpr float kMinShare = 1e-3f;  ///< of the motion, and of the weight of a patch

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// (u, v, distance) so that the surface plus distance along its normal is `p`, from a start.
/// False where the method does not converge.
bool solve_uvd(std::span<const Vec4> patch, const Vec3& p, float size, Vec3& uvd) {
    for (int i = 0; i < kNewtonSteps; ++i) {
        const PatchPoint at = evaluate_patch(patch, uvd.x, uvd.y);
        const Vec3 residual = p - (at.position + uvd.z * at.normal);
        const Mat3 axes = patch_axes(at, uvd.z);
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
    for (int i = 0; i <= kFootSamples; ++i) {
        for (int j = 0; i + j <= kFootSamples; ++j) {
            const Vec2 at = Vec2(i, j) / static_cast<float>(kFootSamples);
            const float distance = glm::distance(evaluate_patch(patch, at.x, at.y).position, p);
            if (distance < nearest) {
                nearest = distance;
                best = {at, 0};
            }
        }
    }
    return best;
}

/// The nearest point of a patch's edges to `p`, but for those edges that `foot`, if it is finite,
/// is inside of.
Vec2 nearest_on_edges(std::span<const Vec4> patch, const Vec3& p, const Vec3& foot) {
    const Vec3 inside = is_finite(foot) ? Vec3(foot.x, foot.y, 1.0f - foot.x - foot.y) : Vec3(-1);
    Vec2 nearest(1.0f / 3.0f);
    float least = INFINITY;
    for (int across = 0; across < 3; ++across) {
        if (inside[across] > 0.0f) {
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

float smooth(float t) {
    const float s = std::clamp(t, 0.0f, 1.0f);
    return s * s * (3.0f - 2.0f * s);
}

/// Faces, with the distances of their flat triangles.
using Faces = std::vector<std::pair<float, std::uint32_t>>;

/// The point of a patch that would move a vertex.
struct Foot {
    SurfaceAnchor anchor;
    float distance = INFINITY;  ///< [m] what the choice depends on
    bool is_inside = false;     ///< perpendicularly below
    bool is_border = false;     ///< of the surface
};

class PatchBinder {
  public:
    PatchBinder(
        std::span<const Vec3> positions, std::span<const std::uint32_t> corners, float max_distance)
        : positions_(positions), corners_(corners), max_distance_(max_distance),
          is_used_(corners.size() / 3, true) {
        make_patches(positions, corners, patches_);
        for (std::size_t f = 0; f < is_used_.size(); ++f) {
            mean_size_ += size_of(f) / static_cast<float>(is_used_.size());
        }
        find_borders();
    }

    /// Of each point, the anchors that share its motion.
    [[nodiscard]] std::vector<std::vector<SurfaceAnchor>> bind(const PointsToBind& points) {
        std::vector<Faces> near(points.positions.size());
        parallel_for(near.size(), kPatchGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                near[v] = nearest_faces(
                    points.positions[v], kCandidates, [&](std::size_t i) { return corner(i); });
            }
        });
        if (!points.triangles.empty()) {
            find_paths(points, near);
        }
        std::vector<std::vector<SurfaceAnchor>> anchors(points.positions.size());
        parallel_for(anchors.size(), kPatchGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                anchors[v] = bind_point(points, v, near[v]);
            }
        });
        return anchors;
    }

    /// One anchor per point.
    [[nodiscard]] std::vector<SurfaceAnchor>
    bind_by_chart(const PointsToBind& points, const PatchChart& chart) const {
        std::vector<SurfaceAnchor> anchors(points.positions.size());
        parallel_for(anchors.size(), kPatchGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                anchors[v] = bind_by_chart(points, v, chart);
                anchors[v].vertex = static_cast<std::uint32_t>(v);
            }
        });
        return anchors;
    }

  private:
    void find_borders() {
        std::map<Edge, int> edges;
        borders_.clear();
        border_corners_.clear();
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            edges[edge_at(i)] += is_used_[i / 3] ? 1 : 0;
        }
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const Edge edge = edge_at(i);
            borders_.push_back(edges[edge] == 1);
            if (borders_.back()) {
                border_corners_.insert({edge.first, edge.second});
            }
        }
    }

    /// From the markers along the mesh, as far as they matter; drops patches that span an opening.
    void find_paths(const PointsToBind& points, const std::vector<Faces>& near) {
        std::vector<float> limits(positions_.size(), 0.0f);
        for (std::size_t v = 0; v < near.size(); ++v) {
            for (const auto& [flat, f] : near[v]) {
                for (std::size_t k = 0; k < 3 && flat <= max_distance_; ++k) {
                    const std::uint32_t marker = corners_[3 * f + k];
                    limits[marker] = std::max(
                        limits[marker],
                        kLongestWay * glm::distance(points.positions[v], positions_[marker]));
                }
            }
        }
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const auto [a, b] = edge_at(i);
            const float needed = kLongestWay * glm::distance(positions_[a], positions_[b]);
            limits[a] = std::max(limits[a], needed);
            limits[b] = std::max(limits[b], needed);
        }
        limits_ = limits;
        paths_ = find_marker_paths(points.positions, points.triangles, positions_, limits);
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const auto [a, b] = edge_at(i);
            if (spans_opening(paths_, positions_, a, b)) {
                is_used_[i / 3] = false;
            }
        }
        if (std::ranges::find(is_used_, true) == is_used_.end()) {
            is_used_.assign(is_used_.size(), true);
        }
        find_borders();
    }

    [[nodiscard]] std::vector<SurfaceAnchor>
    bind_point(const PointsToBind& points, std::size_t v, const Faces& near) const {
        const Vec3 p = points.positions[v];
        std::vector<Foot> feet;
        float least = INFINITY;
        for (const auto& [flat, f] : near) {
            // A patch bulges less than its size.
            if (!is_used_[f] || flat - 0.5f * size_of(f) > (1.0f + kBlend) * least) {
                continue;
            }
            Foot foot = find_foot(p, f);
            foot.distance = glm::length(foot.anchor.offset) + detour(v, p, foot.anchor)
                            + away(points.normals[v], f);
            least = std::min(least, foot.distance);
            feet.push_back(foot);
        }
        std::ranges::sort(feet, {}, &Foot::distance);
        const float blend = kBlend * smooth((least / mean_size_ - kAlone) / (kShared - kAlone));
        float end = (1.0f + blend) * least;
        if (feet.size() > kMaxAnchors) {
            end = std::min(end, feet[kMaxAnchors].distance);
            feet.resize(kMaxAnchors);
        }
        // The nearest alone where all are equally near, as on an edge.
        std::vector<SurfaceAnchor> anchors;
        const float follows =
            feet.empty() ? 0.0f : share_of(feet[0].anchor.offset, feet[0].is_border);
        float sum = 0.0f;
        for (const Foot& foot : feet) {
            const float weight = end > least       ? smooth((end - foot.distance) / (end - least))
                                 : anchors.empty() ? 1.0f
                                                   : 0.0f;
            SurfaceAnchor anchor =
                finished(foot.anchor, points.normals[v], Vec3(points.tangents[v]));
            if (anchor.patch != kNoPatch && weight > kMinShare) {
                sum += weight;
                anchor.share = weight * follows;
                anchor.vertex = static_cast<std::uint32_t>(v);
                anchors.push_back(anchor);
            }
        }
        for (SurfaceAnchor& anchor : anchors) {
            anchor.share /= sum;
        }
        return follows < kMinShare ? std::vector<SurfaceAnchor>{} : anchors;
    }

    [[nodiscard]] SurfaceAnchor
    bind_by_chart(const PointsToBind& points, std::size_t v, const PatchChart& chart) const {
        const Vec3 p = points.positions[v];
        const Faces near =
            nearest_faces(Vec3(chart.points[v], 0), kChartNeighbors, [&](std::size_t i) {
                return Vec3(chart.corners[i], 0);
            });
        Foot foot;
        for (std::size_t i = 0; i < near.size() && !foot.is_inside; ++i) {
            const Foot other = find_foot(p, near[i].second);
            if (i == 0 || other.is_inside) {
                foot = other;
            }
        }
        // Points beyond the border are bound where the surface covers them closely.
        const bool is_beyond = !near.empty() && near[0].first > kOnChart;
        if (near.empty() || (!foot.is_inside && foot.is_border)
            || (is_beyond
                && !(glm::length(foot.anchor.offset) < kCloseTo * size_of(foot.anchor.patch)))
            || glm::length(foot.anchor.offset) > max_distance_) {
            return {};
        }
        return finished(foot.anchor, points.normals[v], Vec3(points.tangents[v]));
    }

    /// The share of the motion at an offset: all within half the largest distance, none at it;
    /// beside the surface it fades out from the border.
    [[nodiscard]] float share_of(const Vec3& offset, bool at_border) const {
        if (!(max_distance_ > 0.0f)) {
            return offset == Vec3(0) ? 1.0f : 0.0f;
        }
        float share = 1.0f - smooth(2.0f * glm::length(offset) / max_distance_ - 1.0f);
        if (at_border) {
            share *= 1.0f - smooth(std::hypot(offset.x, offset.y) / max_distance_);
        }
        return share;
    }

    /// Adds normal and tangent, or returns an unbound anchor.
    [[nodiscard]] SurfaceAnchor
    finished(SurfaceAnchor anchor, const Vec3& normal, const Vec3& tangent) const {
        const PatchPoint at = evaluate_patch(patch(anchor.patch), anchor.u, anchor.v);
        const Mat3 axes = patch_axes(at, anchor.offset.z);
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

    [[nodiscard]] float size_of(std::size_t f) const {
        return std::max(
            glm::distance(corner(3 * f), corner(3 * f + 1)),
            glm::distance(corner(3 * f), corner(3 * f + 2)));
    }

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

    /// Perpendicularly below the point, or else the nearest point of the edges.
    [[nodiscard]] Foot find_foot(const Vec3& p, std::uint32_t f) const {
        Foot foot;
        foot.anchor.patch = f;
        const Vec3 start = nearest_sample(patch(f), p);
        const PatchPoint near = evaluate_patch(patch(f), start.x, start.y);
        Vec3 at = start;
        at.z = glm::dot(p - near.position, near.normal);
        const bool is_solved = solve_uvd(patch(f), p, size_of(f), at);
        if (is_solved && is_inside_chart(at)) {
            foot.is_inside = true;
            foot.anchor.u = at.x;
            foot.anchor.v = at.y;
            foot.anchor.offset = {0, 0, at.z};
            return foot;
        }
        const Vec2 uv = nearest_on_edges(patch(f), p, is_solved ? at : Vec3(NAN));
        const PatchPoint on = evaluate_patch(patch(f), uv.x, uv.y);
        foot.anchor.u = uv.x;
        foot.anchor.v = uv.y;
        foot.anchor.offset = glm::transpose(patch_frame(on)) * (p - on.position);
        const Vec3 weights(uv, 1.0f - uv.x - uv.y);
        for (std::size_t k = 0; k < 3; ++k) {
            // All of a corner's patches see it alike.
            const std::size_t across = (k + 2) % 3;
            foot.is_border =
                foot.is_border
                || (borders_[3 * f + k] && weights[static_cast<int>(across)] <= kInside)
                || (weights[static_cast<int>(k)] >= 1.0f - kInside
                    && border_corners_.contains(corners_[3 * f + k]));
        }
        return foot;
    }

    /// By how much the way along the mesh exceeds the straight line to the foot.
    [[nodiscard]] float detour(std::size_t v, const Vec3& p, const SurfaceAnchor& foot) const {
        if (paths_.lengths.empty()) {
            return 0.0f;
        }
        const Vec3 weights(foot.u, foot.v, 1.0f - foot.u - foot.v);
        float way = 0.0f;
        float straight = 0.0f;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t marker = corners_[3 * foot.patch + static_cast<std::size_t>(k)];
            way += weights[k] * std::min(paths_.at(marker, v), limits_[marker]);
            straight += weights[k] * glm::distance(p, positions_[marker]);
        }
        return std::max(way - kEdgeSlack * straight, 0.0f);
    }

    /// By how much a patch that faces away from a normal is farther: of two lips that touch, a
    /// vertex follows its own.
    [[nodiscard]] float away(const Vec3& normal, std::size_t f) const {
        const Vec3 area =
            glm::cross(corner(3 * f + 1) - corner(3 * f), corner(3 * f + 2) - corner(3 * f));
        return kFacingAway * size_of(f)
               * smooth(-2.0f * glm::dot(normalize_or(area, Vec3(0)), normal));
    }

    std::span<const Vec3> positions_;
    std::span<const std::uint32_t> corners_;
    float max_distance_;
    float mean_size_ = 0.0f;  ///< of the patches
    std::vector<Vec4> patches_;
    std::vector<bool> is_used_;  ///< per patch; false: it spans an opening
    std::vector<bool> borders_;  ///< of the edge from each corner to the next
    std::set<std::uint32_t> border_corners_;
    MarkerPaths paths_;          ///< none: ways are straight
    std::vector<float> limits_;  ///< of the paths
};

}  // namespace

std::vector<SurfaceAnchor> bind_to_patches(
    const PointsToBind& points, std::span<const Vec3> positions,
    std::span<const std::uint32_t> corners, float max_distance, const PatchChart& chart) {
    LIMN_CHECK(chart.corners.empty() || chart.corners.size() == corners.size());
    PatchBinder binder(positions, corners, max_distance);
    if (!chart.corners.empty()) {
        return binder.bind_by_chart(points, chart);
    }
    const std::vector<std::vector<SurfaceAnchor>> found = binder.bind(points);
    std::vector<SurfaceAnchor> anchors(found.size());
    for (std::size_t v = 0; v < found.size(); ++v) {
        std::size_t last = v;
        for (std::size_t i = 0; i < found[v].size(); ++i) {
            if (i == 0) {
                anchors[v] = found[v][0];
                continue;
            }
            anchors[last].next = static_cast<std::uint32_t>(anchors.size());
            last = anchors.size();
            anchors.push_back(found[v][i]);
        }
    }
    return anchors;
}

}  // namespace limn
