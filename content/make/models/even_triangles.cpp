#include "content/make/models/even_triangles.h"

#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <utility>
#include <vector>

namespace limn {

namespace {

/// Triangles by vertex, and the position of each half edge.
class Topology {
  public:
    explicit Topology(const ImplicitMesh& mesh)
        : mesh_(mesh), neighbors_(mesh.positions.size(), 0) {
        half_edges_.reserve(mesh.indices.size());
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            half_edges_.emplace(key(from(i), to(i)), i);
            ++neighbors_[from(i)];
        }
    }

    [[nodiscard]] std::uint32_t from(std::size_t i) const { return mesh_.indices[i]; }
    [[nodiscard]] std::uint32_t to(std::size_t i) const { return mesh_.indices[next(i)]; }
    /// The corner opposite to the half edge `i` of its triangle.
    [[nodiscard]] std::uint32_t opposite(std::size_t i) const {
        return mesh_.indices[next(next(i))];
    }
    /// The half edge on the other side.
    [[nodiscard]] std::size_t twin(std::size_t i) const {
        const auto found = half_edges_.find(key(to(i), from(i)));
        return found == half_edges_.end() ? i : found->second;
    }
    [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const {
        return half_edges_.contains(key(a, b)) || half_edges_.contains(key(b, a));
    }
    [[nodiscard]] int neighbors(std::uint32_t v) const { return neighbors_[v]; }

    static std::size_t next(std::size_t i) { return i % 3 == 2 ? i - 2 : i + 1; }

  private:
    static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
        return (static_cast<std::uint64_t>(a) << 32) | b;
    }
    const ImplicitMesh& mesh_;
    std::vector<int> neighbors_;
    std::unordered_map<std::uint64_t, std::size_t> half_edges_;
};

Vec3 area_vector(const ImplicitMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto& p = mesh.positions;
    return glm::cross(p[b] - p[a], p[c] - p[a]);
}

/// Each triangle takes part in one flip a round, so that the topology of its start holds.
void flip_edges(ImplicitMesh& mesh) {
    const Topology topology(mesh);
    std::vector<bool> touched(mesh.positions.size(), false);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t j = topology.twin(i);
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[Topology::next(i)];
        if (j <= i || touched[a] || touched[b]) {
            continue;
        }
        const std::uint32_t c = mesh.indices[Topology::next(Topology::next(i))];
        const std::uint32_t d = mesh.indices[Topology::next(Topology::next(j))];
        if (touched[c] || touched[d] || topology.has_edge(c, d)) {
            continue;
        }
        const auto off = [&](std::uint32_t v, int more) {
            return square(topology.neighbors(v) + more - 6);
        };
        const int gain = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0) - off(a, -1) - off(b, -1)
                         - off(c, 1) - off(d, 1);
        const auto& p = mesh.positions;
        const float now =
            std::min(triangle_quality(p[a], p[b], p[c]), triangle_quality(p[b], p[a], p[d]));
        const float then =
            std::min(triangle_quality(p[c], p[a], p[d]), triangle_quality(p[d], p[b], p[c]));
        const Vec3 normal = area_vector(mesh, a, b, c) + area_vector(mesh, b, a, d);
        const bool folds = glm::dot(area_vector(mesh, c, a, d), normal) <= 0
                           || glm::dot(area_vector(mesh, d, b, c), normal) <= 0;
        constexpr float kSliver = 0.5f;  // its shape counts more than the number of neighbors
        const bool better =
            std::min(then, now) < kSliver ? then > now : then > 0.8f * now && gain > 0;
        if (folds || !better) {
            continue;
        }
        // (a, b, c), (b, a, d) become (c, a, d), (d, b, c).
        const std::size_t first = 3 * (i / 3);
        const std::size_t second = 3 * (j / 3);
        const std::array<std::uint32_t, 6> made = {c, a, d, d, b, c};
        std::copy_n(made.begin(), 3, mesh.indices.begin() + static_cast<std::ptrdiff_t>(first));
        std::copy_n(
            made.begin() + 3, 3, mesh.indices.begin() + static_cast<std::ptrdiff_t>(second));
        touched[a] = touched[b] = touched[c] = touched[d] = true;
    }
}

/// Both ends of a short edge, or of one at a vertex with three neighbors, become one, where exactly
/// two triangles meet at it and no triangle would fold.
void collapse_edges(ImplicitMesh& mesh, float shortest) {
    const Topology topology(mesh);
    std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());  // triangles
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        around[mesh.indices[i]].push_back(static_cast<std::uint32_t>(i / 3));
    }
    std::vector<bool> touched(mesh.positions.size(), false);
    std::vector<std::uint32_t> becomes(mesh.positions.size());
    for (std::uint32_t v = 0; v < becomes.size(); ++v) {
        becomes[v] = v;
    }
    const auto ring = [&](std::uint32_t v) {
        std::vector<std::uint32_t> found;
        for (const std::uint32_t t : around[v]) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t other = mesh.indices[3 * t + k];
                if (other != v) {
                    found.push_back(other);
                }
            }
        }
        std::ranges::sort(found);
        found.erase(std::unique(found.begin(), found.end()), found.end());
        return found;
    };
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[Topology::next(i)];
        auto& p = mesh.positions;
        const bool needless = topology.neighbors(a) == 3 || topology.neighbors(b) == 3;
        if (a > b || (!needless && glm::distance(p[a], p[b]) >= shortest)) {
            continue;
        }
        const auto of_a = ring(a);
        const auto of_b = ring(b);
        const auto is_touched = [&](std::uint32_t v) { return touched[v]; };
        if (std::ranges::any_of(of_a, is_touched) || std::ranges::any_of(of_b, is_touched)) {
            continue;
        }
        std::vector<std::uint32_t> shared;
        std::ranges::set_intersection(of_a, of_b, std::back_inserter(shared));
        const Vec3 middle = topology.neighbors(b) == 3   ? p[a]
                            : topology.neighbors(a) == 3 ? p[b]
                                                         : 0.5f * (p[a] + p[b]);
        Vec3 normal(0);  // of the surface there; that of a sliver means nothing
        for (const std::uint32_t v : {a, b}) {
            for (const std::uint32_t t : around[v]) {
                const std::uint32_t* const corner = &mesh.indices[3 * static_cast<std::size_t>(t)];
                normal += area_vector(mesh, corner[0], corner[1], corner[2]);
            }
        }
        const auto folds = [&](std::uint32_t v) {
            return std::ranges::any_of(around[v], [&](std::uint32_t t) {
                std::array<Vec3, 3> corners{};
                bool has_a = false;
                bool has_b = false;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::uint32_t corner = mesh.indices[3 * t + k];
                    has_a = has_a || corner == a;
                    has_b = has_b || corner == b;
                    corners[k] = corner == v ? middle : p[corner];
                }
                const Vec3 after = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
                return !(has_a && has_b)
                       && glm::dot(normal, after) < 0.3f * glm::length(normal) * glm::length(after);
            });
        };
        if (shared.size() != 2 || folds(a) || folds(b)) {
            continue;
        }
        p[a] = middle;
        becomes[b] = a;
        touched[a] = touched[b] = true;
        for (const std::uint32_t v : of_a) {
            touched[v] = true;
        }
        for (const std::uint32_t v : of_b) {
            touched[v] = true;
        }
    }
    std::vector<std::uint32_t> kept;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const std::array<std::uint32_t, 3> v = {
            becomes[mesh.indices[t]], becomes[mesh.indices[t + 1]], becomes[mesh.indices[t + 2]]};
        if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) {
            kept.insert(kept.end(), v.begin(), v.end());
        }
    }
    mesh.indices = std::move(kept);
}

/// Vertices that no triangle uses are dropped.
void compact(ImplicitMesh& mesh) {
    constexpr std::uint32_t kUnused = 0xffffffffu;
    std::vector<std::uint32_t> moved(mesh.positions.size(), kUnused);
    std::vector<Vec3> positions;
    for (std::uint32_t& v : mesh.indices) {
        if (moved[v] == kUnused) {
            moved[v] = static_cast<std::uint32_t>(positions.size());
            positions.push_back(mesh.positions[v]);
        }
        v = moved[v];
    }
    mesh.positions = std::move(positions);
}

float mean_edge(const ImplicitMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        sum += static_cast<double>(glm::distance(
            mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[Topology::next(i)]]));
    }
    return static_cast<float>(
        sum / static_cast<double>(std::max<std::size_t>(mesh.indices.size(), 1)));
}

}  // namespace

float triangle_quality(const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto length2 = [](const Vec3& v) { return glm::dot(v, v); };
    const float edges = length2(b - a) + length2(c - b) + length2(a - c);
    return edges > 0 ? 2.0f * std::sqrt(3.0f) * glm::length(glm::cross(b - a, c - a)) / edges : 0;
}

void even_triangles(ImplicitMesh& mesh, const SignedDistance& distance, float cell, int rounds) {
    const float shortest = 0.5f * mean_edge(mesh);
    for (int round = 0; round < rounds; ++round) {
        collapse_edges(mesh, shortest);
        flip_edges(mesh);
        flip_edges(mesh);
        relax_on_surface(mesh, distance, cell, 2);
    }
    for (int i = 0; i < 3; ++i) {  // each pass changes a vertex at most once
        flip_edges(mesh);
        collapse_edges(mesh, shortest);
        relax_on_surface(mesh, distance, cell, 1);
    }
    compact(mesh);
    mesh.normals.resize(mesh.positions.size());
    parallel_for(mesh.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            mesh.normals[v] = surface_normal(distance, mesh.positions[v], 0.25f * cell);
        }
    });
}

}  // namespace limn
