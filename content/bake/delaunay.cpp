#include "content/bake/delaunay.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace limn {
namespace {

using DVec2 = glm::dvec2;
using Corners = std::array<std::size_t, 3>;

double turn_of(const DVec2& a, const DVec2& b, const DVec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d is within the circle through a, b and c, which turn counter-clockwise.
bool is_in_circle(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d) {
    const DVec2 p = a - d;
    const DVec2 q = b - d;
    const DVec2 r = c - d;
    return glm::dot(p, p) * (q.x * r.y - q.y * r.x) - glm::dot(q, q) * (p.x * r.y - p.y * r.x)
               + glm::dot(r, r) * (p.x * q.y - p.y * q.x)
           > 0.0;
}

}  // namespace

std::vector<std::uint32_t> triangulate_points(std::span<const glm::dvec2> points) {
    std::vector<DVec2> flat(points.begin(), points.end());
    const std::size_t count = flat.size();
    double size = 1e-6;
    for (const DVec2& p : flat) {
        size = std::max(size, glm::distance(p, flat[0]));
    }
    // A triangle around all points, far enough out that it hardly distorts the hull.
    const DVec2 origin = flat.empty() ? DVec2(0) : flat[0];
    flat.push_back(origin + 1e4 * size * DVec2(-1, -1));
    flat.push_back(origin + 1e4 * size * DVec2(1, -1));
    flat.push_back(origin + 1e4 * size * DVec2(0, 1));
    std::vector<Corners> triangles = {{count, count + 1, count + 2}};
    for (std::size_t i = 0; i < count; ++i) {
        const bool is_twin = std::any_of(
            flat.begin(), flat.begin() + static_cast<std::ptrdiff_t>(i),
            [&](const DVec2& p) { return p == flat[i]; });
        if (is_twin) {
            continue;
        }
        std::map<std::pair<std::size_t, std::size_t>, int> edges;  // of the removed triangles
        std::erase_if(triangles, [&](const Corners& t) {
            const bool out = is_in_circle(flat[t[0]], flat[t[1]], flat[t[2]], flat[i]);
            for (std::size_t k = 0; out && k < 3; ++k) {
                ++edges[{t[k], t[(k + 1) % 3]}];
            }
            return out;
        });
        for (const auto& [edge, times] : edges) {
            if (!edges.contains({edge.second, edge.first})) {
                triangles.push_back({edge.first, edge.second, i});
            }
        }
    }
    std::vector<std::uint32_t> indices;
    for (const Corners& t : triangles) {
        if (std::max({t[0], t[1], t[2]}) < count
            && turn_of(flat[t[0]], flat[t[1]], flat[t[2]]) > 1e-9 * size * size) {
            for (const std::size_t corner : t) {
                indices.push_back(static_cast<std::uint32_t>(corner));
            }
        }
    }
    return indices;
}

}  // namespace limn
