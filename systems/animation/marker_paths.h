#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// How far it is from markers to the vertices of a mesh along its surface, so that lips which touch
// are far from each other: the shortest ways along edges, E. W. Dijkstra, "A note on two problems
// in connexion with graphs", 1959. On equilateral triangles they are up to 15 % too long, on halved
// squares up to 41 %. From a marker beside the mesh, a way begins with a straight line to the
// nearest vertex; each connected part of the mesh has its own.

struct MarkerPaths {
    std::vector<float> lengths;  ///< [m] by marker and vertex; infinite beyond the limits
    std::size_t vertices = 0;

    // Per marker: the nearest vertex of the part with the most vertices, and its distance [m].
    std::vector<std::uint32_t> feet;
    std::vector<float> heights;

    [[nodiscard]] float at(std::size_t marker, std::size_t vertex) const {
        return lengths[marker * vertices + vertex];
    }
};

/// `limits`: of the lengths [m] from each marker. Vertices at one position are one.
[[nodiscard]] MarkerPaths find_marker_paths(
    std::span<const Vec3> positions, std::span<const std::uint32_t> triangles,
    std::span<const Vec3> markers, std::span<const float> limits);

/// Whether the way from one marker to another is much longer than the straight line, as between
/// lips that touch. False unless both are near the mesh.
[[nodiscard]] bool spans_opening(
    const MarkerPaths& paths, std::span<const Vec3> markers, std::size_t a, std::size_t b);

}  // namespace limn
