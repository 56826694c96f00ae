#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace limn {

// Points on the skin of a face, which keep their place on it while it moves.

/// A point of a triangle.
struct SkinPoint {
    std::array<std::uint32_t, 3> vertices = {0, 0, 0};  ///< corners
    Vec3 weights = {1, 0, 0};                           ///< barycentric
};

/// Vertices that the shapes of a mesh move, counted for each shape.
[[nodiscard]] std::size_t count_moved(const MeshData& mesh);

/// The mesh whose shapes move most vertices; nullptr: no mesh has shapes.
[[nodiscard]] const MeshData* find_face_skin(std::span<const MeshData> meshes);

/// Where the point is while the vertices are at `positions`.
[[nodiscard]] Vec3 position_on(const SkinPoint& point, std::span<const Vec3> positions);

/// The point of the mesh at rest that is nearest to `position`; it has at least one vertex.
[[nodiscard]] SkinPoint nearest_on_mesh(const MeshData& mesh, const Vec3& position);

/// The first point that a ray meets on the mesh, whose vertices are at `positions`.
[[nodiscard]] std::optional<SkinPoint> hit_mesh_at(
    const MeshData& mesh, std::span<const Vec3> positions, const Vec3& origin,
    const Vec3& direction);

}  // namespace limn
