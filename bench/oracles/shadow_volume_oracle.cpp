#include "bench/oracles/shadow_volume_oracle.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <utility>

// Techniques: shadow.volume-count

namespace limn::oracle {
namespace {

constexpr double kVolumePi = 3.14159265358979323846;

/// Intersection of the line from + t (to - from) with the triangle: t, and whether it hits the
/// front; {0, false, false} without an intersection.
struct Crossing {
    double t = 0;
    bool meets = false;
    bool front = false;
};

/// By the signs of three determinants: the line must pass all edges on the same side.
Crossing cross_triangle(const DTriangle& triangle, const DVec3& from, const DVec3& to) {
    const DVec3 d = to - from;
    const DVec3 a = triangle[0] - from;
    const DVec3 b = triangle[1] - from;
    const DVec3 c = triangle[2] - from;
    const double u = glm::dot(d, glm::cross(b, c));
    const double v = glm::dot(d, glm::cross(c, a));
    const double w = glm::dot(d, glm::cross(a, b));
    const bool inside = (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
    if (!inside) {
        return {};
    }
    const DVec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    return {glm::dot(normal, a) / glm::dot(normal, d), true, glm::dot(normal, d) < 0};
}

}  // namespace

DVec3 extrude(const DVec3& p, const DVec3& light, double distance) {
    return p + glm::normalize(p - light) * distance;
}

int z_pass_count(std::span<const DTriangle> volume, const DVec3& eye, const DVec3& point) {
    int count = 0;
    for (const DTriangle& triangle : volume) {
        const Crossing crossing = cross_triangle(triangle, eye, point);
        if (crossing.meets && crossing.t > 0 && crossing.t < 1) {
            count += crossing.front ? 1 : -1;
        }
    }
    return count;
}

int z_fail_count(std::span<const DTriangle> volume, const DVec3& eye, const DVec3& point) {
    int count = 0;
    for (const DTriangle& triangle : volume) {
        const Crossing crossing = cross_triangle(triangle, eye, point);
        if (crossing.meets && crossing.t > 1) {
            count += crossing.front ? -1 : 1;
        }
    }
    return count;
}

int winding_number(std::span<const DTriangle> volume, const DVec3& point) {
    // The solid angle of a triangle: van Oosterom and Strackee 1983.
    double sum = 0;
    for (const DTriangle& triangle : volume) {
        const DVec3 a = triangle[0] - point;
        const DVec3 b = triangle[1] - point;
        const DVec3 c = triangle[2] - point;
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        sum += 2
               * std::atan2(
                   glm::dot(a, glm::cross(b, c)),
                   la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return static_cast<int>(std::lround(sum / (4 * kVolumePi)));
}

bool segment_hits(std::span<const DTriangle> mesh, const DVec3& from, const DVec3& to) {
    for (const DTriangle& triangle : mesh) {
        const Crossing crossing = cross_triangle(triangle, from, to);
        if (crossing.meets && crossing.t > 0 && crossing.t < 1) {
            return true;
        }
    }
    return false;
}

double signed_volume(std::span<const DTriangle> volume) {
    double sum = 0;
    for (const DTriangle& t : volume) {
        sum += glm::dot(t[0], glm::cross(t[1], t[2])) / 6;
    }
    return sum;
}

int open_directed_edges(std::span<const DTriangle> volume) {
    using Key = std::array<double, 3>;
    std::map<std::pair<Key, Key>, int> balance;
    const auto key = [](const DVec3& p) { return Key{p.x, p.y, p.z}; };
    for (const DTriangle& t : volume) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Key from = key(t[k]);
            const Key to = key(t[(k + 1) % 3]);
            if (from < to) {
                ++balance[{from, to}];
            } else if (to < from) {
                --balance[{to, from}];
            }
        }
    }
    int open = 0;
    for (const auto& [edge, count] : balance) {
        open += std::abs(count);
    }
    return open;
}

int count_nondegenerate(std::span<const DTriangle> volume) {
    int count = 0;
    for (const DTriangle& t : volume) {
        count += glm::length(glm::cross(t[1] - t[0], t[2] - t[0])) > 1e-12 ? 1 : 0;
    }
    return count;
}

}  // namespace limn::oracle
