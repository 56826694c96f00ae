#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstddef>

namespace limn {

/// Collapses edges until about `triangles` are left, or until the error would exceed 5 % of the
/// size of the mesh. Unused vertices are removed, with their skin weights and morph targets; the
/// others keep their positions, and closed surfaces stay closed. With `colors` above 0, dark
/// vertices count as that fraction of the size closer to the center than bright ones: a line
/// between colors is then an edge of the shape, and stays.
void simplify_mesh(MeshData& mesh, std::size_t triangles, float colors = 0);

/// Merges vertices in cells of a grid until at most `triangles` are left, for what is small on
/// screen: surfaces may join, holes and fingers vanish. Vertices that are left keep everything.
void merge_mesh(MeshData& mesh, std::size_t triangles);

struct SimplifiedShape {
    MeshId mesh;
    int triangles = 300;
    bool merge = false;
    float colors = 0;
    int joints = 0;
};

LIMN_FIELDS(SimplifiedShape) {
    LIMN_FIELD(mesh, "the mesh to simplify, by name; must come earlier in the file");
    LIMN_FIELD(triangles, "approximate number of triangles to keep", "", 4, 1000000);
    LIMN_FIELD(
        merge, "lets surfaces join and details vanish: a few hundred triangles of anything, for "
               "what is far away");
    LIMN_FIELD(
        colors,
        "how much edges between bright and dark vertex colors count, such as those of lips, as if "
        "black were this fraction of the size deeper than white; not for merge",
        "", 0, 1);
    LIMN_FIELD(
        joints,
        "its skin needs only as many of the first joints: the others, such as fingers, "
        "follow their parents, and a crowd_pose leaves them out; 0 = all of them",
        "", 0, 65535);
}

/// A simplified copy of another mesh of the level, as a control surface for it (surface_binding),
/// with its skin weights and morph targets. Empty without a mesh.
[[nodiscard]] MeshData make_simplified(const SimplifiedShape& shape, const Assets& assets);

}  // namespace limn
