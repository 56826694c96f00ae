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

constexpr double kMinDiffusionWeight =
    0.0025;                           ///< smaller weights, in both directions, are dropped
constexpr double kMaxStep = 2.0 / 3;  ///< fraction moved per step; keeps S >= 0 for equal triangles

/// Neighbors of each vertex, sorted.
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

/// A sparse row: sums of weights by vertex.
class DiffusionRow {
  public:
    explicit DiffusionRow(std::size_t vertices) : sums_(vertices, 0.0) {}

    void add(std::uint32_t vertex, double weight) {
        if (sums_[vertex] == 0) {
            touched_.push_back(vertex);
        }
        sums_[vertex] += weight;
    }

    /// Sorted by vertex; the row is empty afterwards.
    std::vector<std::pair<std::uint32_t, double>> take() {
        std::ranges::sort(touched_);
        std::vector<std::pair<std::uint32_t, double>> weights;
        for (const std::uint32_t vertex : touched_) {
            weights.emplace_back(vertex, sums_[vertex]);
            sums_[vertex] = 0;
        }
        touched_.clear();
        return weights;
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
        diffusion.first.push_back(static_cast<std::uint32_t>(diffusion.weights.size()));
        std::vector<std::pair<std::uint32_t, double>> weights = {{welded[v], 1.0}};
        for (int n = 0; n < steps && area[welded[v]] > 0; ++n) {
            for (const auto& [i, weight] : weights) {
                double kept = weight;
                for (const std::uint32_t j : neighbors[i]) {
                    const double moved = weight * step * std::min(per_neighbor(i), per_neighbor(j))
                                         / std::max(double{area[i]}, 1e-300);
                    kept -= moved;
                    row.add(j, moved);
                }
                row.add(i, kept);
            }
            weights = row.take();
        }
        const double own_area = double{area[welded[v]]};
        for (const auto& [vertex, weight] : weights) {
            const double back = weight * own_area / std::max(double{area[vertex]}, 1e-300);
            row.add(std::max(weight, back) < kMinDiffusionWeight ? welded[v] : vertex, weight);
        }
        for (const auto& [vertex, weight] : row.take()) {
            diffusion.weights.emplace_back(vertex, static_cast<float>(weight));
        }
    }
    diffusion.first.push_back(static_cast<std::uint32_t>(diffusion.weights.size()));
    return diffusion;
}

DiffusedCorners
diffuse_corners(const SkinDiffusion& diffusion, const WrinkleRest& rest, std::uint32_t group) {
    DiffusedCorners diffused;
    DiffusionRow groups(rest.corners.size() / group);
    for (std::size_t v = 0; v + 1 < rest.first.size(); ++v) {
        diffused.first.push_back(static_cast<std::uint32_t>(diffused.around.size()));
        for (std::uint32_t i = diffusion.first[v]; i < diffusion.first[v + 1]; ++i) {
            const auto& [from, weight] = diffusion.weights[i];
            for (std::uint32_t k = rest.first[from]; k < rest.first[from + 1]; ++k) {
                const WrinkleCorner& at = rest.around[k];
                groups.add(at.corner / group, double{weight} * double{at.weight});
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
