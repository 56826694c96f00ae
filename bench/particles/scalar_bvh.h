#pragma once

#include "ecs/base/math.h"
#include "systems/particles/mesh_bvh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace limn::bench {

// The obvious BVH to trace segments: two children per node, split by the surface area heuristic
// over 16 bins, leaves of at most 4 triangles, one box and one triangle at a time, the nearer child
// first. Triangles after Moeller and Trumbore (1997).

class ScalarBvh {
  public:
    ScalarBvh(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
        for (std::size_t i = 0; i < indices.size(); i += 3) {
            const Vec3 a = positions[indices[i]];
            const Vec3 b = positions[indices[i + 1]];
            const Vec3 c = positions[indices[i + 2]];
            triangles_.push_back({a, b - a, c - a});
        }
        nodes_.reserve(triangles_.size());
        nodes_.emplace_back();
        split(0, 0, triangles_.size());
    }

    /// Fraction of the segment, 0 .. 1, or 2 if nothing is hit.
    [[nodiscard]] float first_hit_fraction(const Segment& segment) const {
        const Vec3 path = segment.to - segment.from;
        const Vec3 inverse = 1.0f / path;
        float best = 2;
        std::uint32_t stack[64];
        std::size_t open = 0;
        float near = 0;
        if (!meets(nodes_[0], segment.from, inverse, 1, near)) {
            return best;
        }
        std::uint32_t next = 0;
        while (true) {
            const Node& node = nodes_[next];
            if (node.count > 0) {
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                    meet(triangles_[i], segment.from, path, best);
                }
            } else {
                const float limit = std::min(best, 1.0f);
                float near_a = 0;
                float near_b = 0;
                const bool a = meets(nodes_[node.first], segment.from, inverse, limit, near_a);
                const bool b = meets(nodes_[node.first + 1], segment.from, inverse, limit, near_b);
                if (a && b) {
                    const bool swapped = near_b < near_a;
                    stack[open++] = node.first + (swapped ? 0 : 1);
                    next = node.first + (swapped ? 1 : 0);
                    continue;
                }
                if (a || b) {
                    next = node.first + (a ? 0 : 1);
                    continue;
                }
            }
            if (open == 0) {
                return best;
            }
            next = stack[--open];
        }
    }

  private:
    struct Triangle {
        Vec3 corner, edge1, edge2;
    };
    struct Node {
        Bounds bounds;
        std::uint32_t first = 0;  ///< triangle, or child: the second one is next to it
        std::uint32_t count = 0;  ///< triangles; 0: two children
    };

    static Bounds bounds_of(const Triangle& t) {
        Bounds bounds;
        grow(bounds, t.corner);
        grow(bounds, t.corner + t.edge1);
        grow(bounds, t.corner + t.edge2);
        return bounds;
    }
    static float area(const Bounds& b) {
        const Vec3 size = b.max - b.min;
        return is_empty(b) ? 0.0f : size.x * size.y + size.y * size.z + size.z * size.x;
    }

    static bool
    meets(const Node& node, const Vec3& from, const Vec3& inverse, float limit, float& near) {
        const Vec3 a = (node.bounds.min - from) * inverse;
        const Vec3 b = (node.bounds.max - from) * inverse;
        const Vec3 enter = glm::min(a, b);
        const Vec3 leave = glm::max(a, b);
        near = std::max(std::max(enter.x, enter.y), std::max(enter.z, 0.0f));
        return near <= std::min(std::min(leave.x, leave.y), std::min(leave.z, limit));
    }

    static void meet(const Triangle& t, const Vec3& from, const Vec3& path, float& best) {
        const Vec3 p = glm::cross(path, t.edge2);
        const float det = glm::dot(t.edge1, p);
        if (det == 0) {
            return;
        }
        const float scale = 1 / det;
        const Vec3 s = from - t.corner;
        const float u = glm::dot(s, p) * scale;
        if (u < 0 || u > 1) {
            return;
        }
        const Vec3 q = glm::cross(s, t.edge1);
        const float v = glm::dot(path, q) * scale;
        const float fraction = glm::dot(t.edge2, q) * scale;
        if (v >= 0 && u + v <= 1 && fraction >= 0 && fraction <= 1) {
            best = std::min(best, fraction);
        }
    }

    void split(std::size_t node, std::size_t first, std::size_t count) {
        constexpr int kBins = 16;
        Bounds bounds;
        Bounds centers;
        for (std::size_t i = first; i < first + count; ++i) {
            const Bounds each = bounds_of(triangles_[i]);
            grow(bounds, each);
            grow(centers, center(each));
        }
        nodes_[node].bounds = bounds;
        if (count <= 4) {
            nodes_[node].first = static_cast<std::uint32_t>(first);
            nodes_[node].count = static_cast<std::uint32_t>(count);
            return;
        }
        const auto bin_of = [&](const Triangle& t, int axis) {
            const float low = centers.min[axis];
            const float extent = centers.max[axis] - low;
            const float at = (center(bounds_of(t))[axis] - low) / extent;
            return std::min(static_cast<int>(at * kBins), kBins - 1);
        };
        float best_cost = INFINITY;
        int best_axis = -1;
        int best_bin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(centers.max[axis] > centers.min[axis])) {
                continue;
            }
            Bounds boxes[kBins];
            std::size_t counts[kBins] = {};
            for (std::size_t i = first; i < first + count; ++i) {
                const int bin = bin_of(triangles_[i], axis);
                grow(boxes[bin], bounds_of(triangles_[i]));
                ++counts[bin];
            }
            for (int cut = 1; cut < kBins; ++cut) {
                Bounds sides[2];
                std::size_t sizes[2] = {};
                for (int bin = 0; bin < kBins; ++bin) {
                    grow(sides[bin < cut ? 0 : 1], boxes[bin]);
                    sizes[bin < cut ? 0 : 1] += counts[bin];
                }
                const float cost = area(sides[0]) * static_cast<float>(sizes[0])
                                   + area(sides[1]) * static_cast<float>(sizes[1]);
                if (sizes[0] > 0 && sizes[1] > 0 && cost < best_cost) {
                    best_cost = cost;
                    best_axis = axis;
                    best_bin = cut;
                }
            }
        }
        std::size_t median = first + count / 2;
        if (best_axis >= 0) {
            const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first);
            const auto end = begin + static_cast<std::ptrdiff_t>(count);
            const auto cut = std::partition(
                begin, end, [&](const Triangle& t) { return bin_of(t, best_axis) < best_bin; });
            median = static_cast<std::size_t>(cut - triangles_.begin());
        }
        const std::size_t child = nodes_.size();
        nodes_.resize(child + 2);
        nodes_[node].first = static_cast<std::uint32_t>(child);
        split(child, first, median - first);
        split(child + 1, median, first + count - median);
    }

    std::vector<Triangle> triangles_;
    std::vector<Node> nodes_;
};

}  // namespace limn::bench
