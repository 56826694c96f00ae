#include "content/load/obj/triangulate_polygon.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace limn {

namespace {

/// Newell's normal: the sum of the cross products of the edges.
glm::dvec3 newell_normal(std::span<const Vec3> p) {
    glm::dvec3 normal(0);
    const glm::dvec3 origin(p[0]);
    for (std::size_t i = 0; i < p.size(); ++i) {
        normal += glm::cross(glm::dvec3(p[i]) - origin, glm::dvec3(p[(i + 1) % p.size()]) - origin);
    }
    return normal;
}

/// The triangles of a quad where one of its diagonals lies inside.
std::optional<std::vector<std::uint32_t>> split_quad(std::span<const Vec3> p) {
    const auto normal = Vec3(newell_normal(p));
    const auto faces_front = [&](std::size_t a, std::size_t b, std::size_t c) {
        return glm::dot(normal, glm::cross(p[b] - p[a], p[c] - p[a])) > 0;
    };
    if (faces_front(0, 1, 2) && faces_front(0, 2, 3)) {
        return std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3};
    }
    if (faces_front(1, 2, 3) && faces_front(1, 3, 0)) {
        return std::vector<std::uint32_t>{0, 1, 3, 1, 2, 3};
    }
    return std::nullopt;
}

constexpr int kMaxRepeats = 100;  // keeps what crosses itself quadratic

class EarCutter {
  public:
    explicit EarCutter(std::span<const Vec3> corners) {
        // Projected along the axis that is closest to the normal, mirrored where that points back.
        const glm::dvec3 normal = newell_normal(corners);
        int axis = 0;
        for (int i = 1; i < 3; ++i) {
            axis = std::abs(normal[i]) > std::abs(normal[axis]) ? i : axis;
        }
        const int x = (axis + (normal[axis] < 0 ? 2 : 1)) % 3;
        const int y = (axis + (normal[axis] < 0 ? 1 : 2)) % 3;
        for (const Vec3& corner : corners) {
            p_.emplace_back(static_cast<double>(corner[x]), static_cast<double>(corner[y]));
        }
        const auto count = static_cast<std::uint32_t>(corners.size());
        next_.resize(count);
        previous_.resize(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            next_[i] = (i + 1) % count;
            previous_[i] = (i + count - 1) % count;
        }
        left_ = count;
    }

    std::vector<std::uint32_t> cut() {
        std::uint32_t last = 0;
        for (std::uint32_t i = 0; i < left_; ++i) {
            queue_.push_back(i);
            if (!(area_at(i) > 0)) {
                reflex_.push_back(i);
            }
        }
        while (left_ > 3) {
            std::optional<std::uint32_t> ear = next_ear();
            if (!ear && repeats_ < kMaxRepeats) {  // what was in the way of one may be cut now
                ++repeats_;
                enqueue_rest(last);
                ear = next_ear();
            }
            if (!ear) {  // it crosses itself, or has no area: any convex corner must do
                ear = find_convex_corner(last);
            }
            last = next_[*ear];
            cut_corner(*ear);
        }
        add_triangle(last);
        return std::move(triangles_);
    }

  private:
    /// Twice the area of a triangle, negative if it faces back.
    [[nodiscard]] double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const glm::dvec2 u = p_[b] - p_[a];
        const glm::dvec2 v = p_[c] - p_[a];
        return u.x * v.y - u.y * v.x;
    }
    [[nodiscard]] double area_at(std::uint32_t corner) const {
        return area(previous_[corner], corner, next_[corner]);
    }
    [[nodiscard]] bool is_cut(std::uint32_t corner) const {
        return next_[previous_[corner]] != corner;
    }

    /// Whether no corner of the rest lies within the triangle or on its edges: only reflex ones
    /// can. One that coincides with an end of the diagonal is where a slit leads to a hole.
    [[nodiscard]] bool is_ear(std::uint32_t b) const {
        const std::uint32_t a = previous_[b];
        const std::uint32_t c = next_[b];
        if (!(area(a, b, c) > 0)) {
            return false;
        }
        const glm::dvec2 low = glm::min(glm::min(p_[a], p_[b]), p_[c]);
        const glm::dvec2 high = glm::max(glm::max(p_[a], p_[b]), p_[c]);
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t r) {
            const glm::dvec2 p = p_[r];
            return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && r != a
                   && r != c && p != p_[a] && p != p_[c] && area(a, b, r) >= 0 && area(b, c, r) >= 0
                   && area(c, a, r) >= 0;
        });
    }

    std::optional<std::uint32_t> next_ear() {
        for (; at_ < queue_.size(); ++at_) {
            if (!is_cut(queue_[at_]) && is_ear(queue_[at_])) {
                return queue_[at_++];
            }
        }
        return std::nullopt;
    }

    void enqueue_rest(std::uint32_t from) {
        for (std::size_t i = 0; i < left_; ++i, from = next_[from]) {
            queue_.push_back(from);
        }
    }

    [[nodiscard]] std::uint32_t find_convex_corner(std::uint32_t from) const {
        for (std::size_t i = 0; i < left_ && !(area_at(from) > 0); ++i) {
            from = next_[from];
        }
        return from;
    }

    void add_triangle(std::uint32_t corner) {
        triangles_.insert(triangles_.end(), {previous_[corner], corner, next_[corner]});
    }

    void cut_corner(std::uint32_t corner) {
        add_triangle(corner);
        const std::uint32_t neighbors[2] = {previous_[corner], next_[corner]};
        next_[neighbors[0]] = neighbors[1];
        previous_[neighbors[1]] = neighbors[0];
        --left_;
        std::erase(reflex_, corner);
        for (const std::uint32_t neighbor : neighbors) {
            queue_.push_back(neighbor);
            if (area_at(neighbor) > 0) {
                std::erase(reflex_, neighbor);
            }
        }
    }

    std::vector<glm::dvec2> p_;
    std::vector<std::uint32_t> next_;      ///< corner of each, in what is left of the polygon
    std::vector<std::uint32_t> previous_;  ///< likewise
    std::vector<std::uint32_t> reflex_;    ///< and straight corners of what is left
    std::vector<std::uint32_t> queue_;     ///< corners to examine, from `at_` on
    std::size_t at_ = 0;
    std::size_t left_ = 0;  ///< corners
    int repeats_ = 0;       ///< how often all that was left was examined again
    std::vector<std::uint32_t> triangles_;
};

}  // namespace

std::vector<std::uint32_t> triangulate_polygon(std::span<const Vec3> corners) {
    if (corners.size() == 4) {
        if (auto triangles = split_quad(corners)) {
            return *std::move(triangles);
        }
    }
    if (corners.size() > 3 && corners.size() <= kMaxEarCorners) {
        return EarCutter(corners).cut();
    }
    std::vector<std::uint32_t> fan;
    for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) {
        fan.insert(fan.end(), {0, i, i + 1});
    }
    return fan;
}

}  // namespace limn
