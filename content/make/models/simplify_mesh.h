#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstddef>

namespace limn {

/// Collapses edges until about `triangles` are left, or until the error would exceed 5 % of the
/// size of the mesh. Unused vertices are removed, with their skin weights and morph targets; the
/// others keep their positions, and closed surfaces stay closed.
void simplify_mesh(MeshData& mesh, std::size_t triangles);

struct SimplifiedShape {
    MeshId mesh;
    int triangles = 300;
};

LIMN_FIELDS(SimplifiedShape) {
    LIMN_FIELD(mesh, "the mesh to simplify, by name; before this one in the file");
    LIMN_FIELD(triangles, "about as many are left", "", 4, 1000000);
}

/// Another mesh of the level, simplified: for a surface that moves it (surface_binding), with its
/// skin weights and morph targets. Empty without a mesh.
[[nodiscard]] MeshData make_simplified(const SimplifiedShape& shape, const Assets& assets);

}  // namespace limn
