#include "systems/animation/marker_paths.h"

#include "ecs/base/jobs.h"
#include "ecs/components/weld.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

// Techniques: face.bids-project

namespace limn {
namespace {

constexpr float kDetour = 2.2f;  ///< longer ways than this, relative to the straight line, span
constexpr float kNearMarker = 0.25f;  ///< of the straight line: how near the mesh its ends must be
constexpr std::uint32_t kNoVertex = 0xffffffffu;

/// Vertices by their first one at the same position, with their neighbors.
struct Graph {
    std::vector<std::uint32_t> welded;
    std::vector<std::uint32_t> first;  ///< neighbor of each vertex, and the end
    std::vector<std::uint32_t> neighbors;
    std::vector<std::uint32_t> parts;  ///< of each vertex
    std::uint32_t part_count = 0;
    std::uint32_t largest = 0;  ///< part
};

Graph make_graph(std::span<const Vec3> positions, std::span<const std::uint32_t> triangles) {
    Graph graph;
    graph.welded = weld_positions(positions);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t i = 0; i + 3 <= triangles.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = graph.welded[triangles[i + k]];
            const std::uint32_t b = graph.welded[triangles[i + (k + 1) % 3]];
            edges.emplace_back(a, b);
            edges.emplace_back(b, a);
        }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    graph.first.resize(positions.size() + 1);
    for (const auto& [from, to] : edges) {
        graph.neighbors.push_back(to);
        ++graph.first[from + 1];
    }
    for (std::size_t v = 0; v < positions.size(); ++v) {
        graph.first[v + 1] += graph.first[v];
    }
    graph.parts.assign(positions.size(), kNoVertex);
    std::vector<std::uint32_t> reached;
    std::size_t most = 0;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (graph.welded[v] != v || graph.parts[v] != kNoVertex) {
            continue;
        }
        reached.assign(1, v);
        graph.parts[v] = graph.part_count;
        for (std::size_t i = 0; i < reached.size(); ++i) {
            for (std::uint32_t n = graph.first[reached[i]]; n < graph.first[reached[i] + 1]; ++n) {
                const std::uint32_t next = graph.neighbors[n];
                if (graph.parts[next] == kNoVertex) {
                    graph.parts[next] = graph.part_count;
                    reached.push_back(next);
                }
            }
        }
        if (reached.size() > most) {
            most = reached.size();
            graph.largest = graph.part_count;
        }
        ++graph.part_count;
    }
    return graph;
}

/// The nearest vertex of each part, and its distance.
std::vector<std::pair<float, std::uint32_t>>
find_starts(const Graph& graph, std::span<const Vec3> positions, const Vec3& marker) {
    std::vector<std::pair<float, std::uint32_t>> starts(graph.part_count, {INFINITY, kNoVertex});
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (graph.welded[v] == v) {
            auto& nearest = starts[graph.parts[v]];
            nearest = std::min(nearest, {glm::distance(positions[v], marker), v});
        }
    }
    return starts;
}

void follow_edges(
    const Graph& graph, std::span<const Vec3> positions,
    const std::vector<std::pair<float, std::uint32_t>>& starts, float limit,
    std::span<float> lengths) {
    using Way = std::pair<float, std::uint32_t>;
    std::priority_queue<Way, std::vector<Way>, std::greater<>> ways;
    const auto reach = [&](float length, std::uint32_t v) {
        if (length < lengths[v] && length <= limit) {
            lengths[v] = length;
            ways.emplace(length, v);
        }
    };
    for (const auto& [distance, v] : starts) {
        if (v != kNoVertex) {
            reach(distance, v);
        }
    }
    while (!ways.empty()) {
        const auto [length, v] = ways.top();
        ways.pop();
        if (length > lengths[v]) {
            continue;
        }
        for (std::uint32_t n = graph.first[v]; n < graph.first[v + 1]; ++n) {
            const std::uint32_t next = graph.neighbors[n];
            reach(length + glm::distance(positions[v], positions[next]), next);
        }
    }
}

}  // namespace

MarkerPaths find_marker_paths(
    std::span<const Vec3> positions, std::span<const std::uint32_t> triangles,
    std::span<const Vec3> markers, std::span<const float> limits) {
    const Graph graph = make_graph(positions, triangles);
    MarkerPaths paths;
    paths.vertices = positions.size();
    paths.lengths.assign(markers.size() * positions.size(), INFINITY);
    paths.feet.resize(markers.size());
    paths.heights.resize(markers.size());
    parallel_for(markers.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const auto starts = find_starts(graph, positions, markers[m]);
            if (!starts.empty()) {
                paths.heights[m] = starts[graph.largest].first;
                paths.feet[m] = starts[graph.largest].second;
            }
            const std::span<float> lengths =
                std::span(paths.lengths).subspan(m * positions.size(), positions.size());
            follow_edges(graph, positions, starts, limits[m], lengths);
            for (std::size_t v = 0; v < positions.size(); ++v) {
                lengths[v] = lengths[graph.welded[v]];
            }
        }
    });
    return paths;
}

bool spans_opening(
    const MarkerPaths& paths, std::span<const Vec3> markers, std::size_t a, std::size_t b) {
    const float straight = glm::distance(markers[a], markers[b]);
    return paths.heights[a] < kNearMarker * straight && paths.heights[b] < kNearMarker * straight
           && paths.at(a, paths.feet[b]) > kDetour * straight;
}

}  // namespace limn
