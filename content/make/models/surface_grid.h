#pragma once

#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

// Parametric surfaces are grids of vertices. Viewed from the front, columns run to the right and
// rows downwards, like the pixels of an image; so an image lies on the surface upright and
// unmirrored, and the bitangent, which points to the top of the image, is + cross(normal, tangent):
// w = +1 everywhere.

/// i / count.
[[nodiscard]] inline float part(int i, int count) {
    return static_cast<float>(i) / static_cast<float>(count);
}

struct GridVertex {
    Vec3 position;
    Vec3 normal;   ///< unit
    Vec3 tangent;  ///< unit, toward the next column
    Vec2 uv;
};

/// Which end rows of the grid are a single point: their degenerate triangles are omitted.
struct GridPoles {
    bool top = false;
    bool bottom = false;
};

/// Appends `columns` x `rows` quads with the vertices vertex(i, j), i = 0 .. columns, j = 0 ..
/// rows.
template <typename MakeVertex>
void append_grid(MeshData& mesh, int columns, int rows, GridPoles poles, MakeVertex&& vertex) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto width = static_cast<std::uint32_t>(columns) + 1;
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const GridVertex v = vertex(i, j);
            mesh.positions.push_back(v.position);
            mesh.normals.push_back(v.normal);
            mesh.tangents.push_back(Vec4(v.tangent, 1.0f));
            mesh.uvs.push_back(v.uv);
            grow(mesh.bounds, v.position);
        }
    }
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const std::uint32_t a =
                first + static_cast<std::uint32_t>(j) * width + static_cast<std::uint32_t>(i);
            const std::uint32_t below = a + width;
            if (!(poles.bottom && j == rows - 1)) {
                mesh.indices.insert(mesh.indices.end(), {a, below, below + 1});
            }
            if (!(poles.top && j == 0)) {
                mesh.indices.insert(mesh.indices.end(), {a, below + 1, a + 1});
            }
        }
    }
}

}  // namespace limn
