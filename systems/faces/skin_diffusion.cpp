#include "systems/faces/skin_diffusion.h"

#include "ecs/base/check.h"
#include "ecs/components/weld.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

// Techniques: wrinkle.smoothing

namespace limn {

namespace {

constexpr double kMinDiffusionWeight = 0.0025;  ///< less of both vertices' values is not moved
constexpr double kMaxStep = 2.0 / 3;  ///< moved away in one step; of equal triangles, S >= 0 then

/// Neighbors of each vertex, in order.
std::vector<std::vector<std::uint32_t>> find_neighbors(
    std::span<const std::uint32_t> welded, std::span<const std::uint32_t> indices,
    std::span<const char> used) {
    std::vector<std::vector<std::uint32_t>> neighbors(welded.size());
    for (std::size_t t = 0; t + 3 <= indices.size(); t += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t i = indices[t + k];
            const std::uint32_t j = indices[t + (k + 1) % 3];
            if (std::max(i, j) < welded.size() && welded[i] != welded[j] && used[welded[i]] != 0
                && used[welded[j]] != 0) {
                neighbors[welded[i]].push_back(welded[j]);
                neighbors[welded[j]].push_back(welded[i]);
            }
        }
    }
    for (std::vector<std::uint32_t>& around : neighbors) {
        std::ranges::sort(around);
        around.erase(std::unique(around.begin(), around.end()), around.end());
    }
    return neighbors;
}

std::vector<float> find_areas(
    std::span<const Vec3> positions, std::span<const std::uint32_t> welded,
    std::span<const std::uint32_t> indices) {
    std::vector<float> area(positions.size(), 0.0f);
    for (std::size_t t = 0; t + 3 <= indices.size(); t += 3) {
        const std::uint32_t* const v = &indices[t];
        if (std::max({v[0], v[1], v[2]}) < positions.size()) {
            const Vec3& p = positions[v[0]];
            const float twice = glm::length(glm::cross(positions[v[1]] - p, positions[v[2]] - p));
            for (std::size_t k = 0; k < 3; ++k) {
                area[welded[v[k]]] += finite_or(twice, 0) / 6;
            }
        }
    }
    return area;
}

/// Sums of shares by vertex.
class DiffusionRow {
  public:
    explicit DiffusionRow(std::size_t vertices) : sums_(vertices, 0.0) {}

    void add(std::uint32_t vertex, double share) {
        if (sums_[vertex] == 0) {
            touched_.push_back(vertex);
        }
        sums_[vertex] += share;
    }

    /// In the order of the vertices; empty afterwards.
    std::vector<std::pair<std::uint32_t, double>> take() {
        std::ranges::sort(touched_);
        std::vector<std::pair<std::uint32_t, double>> shares;
        for (const std::uint32_t vertex : touched_) {
            shares.emplace_back(vertex, sums_[vertex]);
            sums_[vertex] = 0;
        }
        touched_.clear();
        return shares;
    }

  private:
    std::vector<double> sums_;
    std::vector<std::uint32_t> touched_;
};

}  // namespace

SkinDiffusion make_skin_diffusion(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    std::span<const char> used, float edges) {
    LIMN_CHECK(used.size() == positions.size());
    LIMN_CHECK(edges >= 0);
    const std::vector<std::uint32_t> welded = weld_positions(positions);
    const auto neighbors = find_neighbors(welded, indices, used);
    SkinDiffusion diffusion;
    diffusion.area = find_areas(positions, welded, indices);
    const std::vector<float>& area = diffusion.area;
    const auto per_neighbor = [&](std::uint32_t i) {
        return double{area[i]} / static_cast<double>(neighbors[i].size());
    };
    const double square_edges = double{edges} * double{edges};
    const int steps = static_cast<int>(std::ceil(square_edges / kMaxStep));
    const double step = steps > 0 ? square_edges / steps : 0.0;

    DiffusionRow row(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        diffusion.first.push_back(static_cast<std::uint32_t>(diffusion.shares.size()));
        std::vector<std::pair<std::uint32_t, double>> shares = {{welded[v], 1.0}};
        for (int n = 0; n < steps && area[welded[v]] > 0; ++n) {
            for (const auto& [i, share] : shares) {
                double left = share;
                for (const std::uint32_t j : neighbors[i]) {
                    const double moved = share * step * std::min(per_neighbor(i), per_neighbor(j))
                                         / std::max(double{area[i]}, 1e-300);
                    left -= moved;
                    row.add(j, moved);
                }
                row.add(i, left);
            }
            shares = row.take();
        }
        const double own_area = double{area[welded[v]]};
        for (const auto& [vertex, share] : shares) {
            const double back = share * own_area / std::max(double{area[vertex]}, 1e-300);
            row.add(std::max(share, back) < kMinDiffusionWeight ? welded[v] : vertex, share);
        }
        for (const auto& [vertex, share] : row.take()) {
            diffusion.shares.emplace_back(vertex, static_cast<float>(share));
        }
    }
    diffusion.first.push_back(static_cast<std::uint32_t>(diffusion.shares.size()));
    return diffusion;
}

DiffusedCorners
diffuse_corners(const SkinDiffusion& diffusion, const WrinkleRest& rest, std::uint32_t group) {
    DiffusedCorners diffused;
    DiffusionRow groups(rest.corners.size() / group);
    for (std::size_t v = 0; v + 1 < rest.first.size(); ++v) {
        diffused.first.push_back(static_cast<std::uint32_t>(diffused.around.size()));
        for (std::uint32_t i = diffusion.first[v]; i < diffusion.first[v + 1]; ++i) {
            const auto& [from, share] = diffusion.shares[i];
            for (std::uint32_t k = rest.first[from]; k < rest.first[from + 1]; ++k) {
                const WrinkleCorner& at = rest.around[k];
                groups.add(at.corner / group, double{share} * double{at.weight});
            }
        }
        for (const auto& [number, weight] : groups.take()) {
            diffused.around.push_back({number, static_cast<float>(weight)});
        }
    }
    diffused.first.push_back(static_cast<std::uint32_t>(diffused.around.size()));
    return diffused;
}

void diffuse_rest(
    WrinkleRest& rest, std::span<const Vec3> positions, std::span<const std::uint32_t> indices,
    float edges) {
    std::vector<char> used;
    for (std::size_t v = 0; v + 1 < rest.first.size(); ++v) {
        used.push_back(rest.first[v] != rest.first[v + 1] ? 1 : 0);
    }
    DiffusedCorners diffused =
        diffuse_corners(make_skin_diffusion(positions, indices, used, edges), rest, 3);
    for (WrinkleCorner& at : diffused.around) {
        at.corner *= 3;
    }
    rest.around = std::move(diffused.around);
    rest.first = std::move(diffused.first);
    rest.wide = true;
}

}  // namespace limn
