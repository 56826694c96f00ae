#pragma once

#include "ecs/base/math.h"
#include "ecs/base/rng.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace limn {

// Random points within a closed mesh, uniform by volume, by rejection sampling. The mesh is
// projected vertically onto a grid of cells; over each cell a box extends from the lowest to the
// highest of its triangles. A point is drawn uniformly from all boxes, and accepted if its winding
// number along +y is not 0, so that overlapping bodies are one. Columns in which the triangles are
// not closed are left out. In the projection, an edge that two triangles share belongs to exactly
// one of them, so that a closed mesh is closed in every column.
//
// Filling takes a pass over the triangles, a point some tens of nanoseconds per triangle over its
// cell: meshes that deform in every step need no hierarchy.

/// The grid of a mesh: keep it from step to step to reuse its memory.
struct MeshVolume {
    int side = 0;                        ///< cells along x and z
    Vec3 low = {0, 0, 0};                ///< of the mesh [m]
    Vec2 cell = {0, 0};                  ///< size along x and z [m]
    std::vector<Vec2> heights{};         ///< lowest and highest y over each cell, x fastest [m]
    std::vector<double> sums{};          ///< volumes of the boxes up to and with each cell [m^3]
    std::vector<std::uint32_t> first{};  ///< of each cell in `triangles`, and their number
    std::vector<std::uint32_t> triangles{};  ///< over the cells, one cell after another
};

/// Three indices per triangle; triangles with indices beyond `positions` or coordinates that are
/// not finite are left out. False if the boxes have no volume.
bool fill_mesh_volume(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, MeshVolume& volume);

/// `volume` was filled from the same mesh.
[[nodiscard]] bool is_in_volume(
    const MeshVolume& volume, std::span<const Vec3> positions,
    std::span<const std::uint32_t> indices, const Vec3& point);

/// None after 64 rejected points: the mesh encloses nothing, or so little of its boxes (less than
/// about a twentieth) that chance may miss it. fill_mesh_volume must have returned true.
[[nodiscard]] std::optional<Vec3> draw_in_volume(
    const MeshVolume& volume, std::span<const Vec3> positions,
    std::span<const std::uint32_t> indices, Random& random);

}  // namespace limn
