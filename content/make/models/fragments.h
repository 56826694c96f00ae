#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Breaks a mesh into pieces, as for objects that burst (engine.explode, particle.mesh-particles).
// Triangles are grouped around evenly spread seeds, growing from neighbor to neighbor, with noise
// so that edges are irregular. Pieces are connected if the mesh is, and their edges follow those of
// triangles: the finer the mesh, the finer the fracture. Each piece gets an inside
// and walls, at a depth below the surface.

struct FragmentsShape {
    MeshId mesh;
    int count = 24;
    float thickness = 0.03f;
    float roughness = 0.5f;
    std::uint32_t seed = 1;
};

LIMN_FIELDS(FragmentsShape) {
    LIMN_FIELD(mesh, "the mesh to break, by name; must come earlier in the file");
    LIMN_FIELD(count, "maximum number of pieces; at most that of triangles", "", 1, 1024);
    LIMN_FIELD(thickness, "depth of the pieces below the surface; 0: sheets", "m", 0, 1e4);
    LIMN_FIELD(roughness, "noise of the edges between pieces", "", 0, 1);
    LIMN_FIELD(seed, "random seed");
}

/// All pieces at their original positions, in sequence. Empty without a mesh or triangles with
/// area. Skin, morph targets, colors and second uvs are left out.
[[nodiscard]] MeshData make_fragments(const FragmentsShape& shape, const Assets& assets);

/// Appends a mesh for each piece of `mesh`, centered at its origin, and stores the ids in `mesh`.
void add_piece_meshes(Assets& assets, MeshId mesh);

}  // namespace limn
