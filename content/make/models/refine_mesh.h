#pragma once

#include "ecs/components/surface.h"
#include "ecs/reflect.h"

namespace limn {

// Triangles small enough to displace by folds of skin (wrinkle.displacement). Edges that are too
// long are halved, all at once, so that triangles with one, two or three such edges become two,
// three or four. Midpoints lie on the cubic curve along both normals (Vlachos, Peters, Boyd and
// Mitchell, "Curved PN Triangles", 2001); other attributes are the mean of both ends. Vertices at
// one position count as one: UV seams stay closed.

/// Halves edges longer than `edge` [m] of regions that fold and of the ring of triangles around
/// them (any edge if the mesh has no regions), at most `times` times and until there are a million
/// vertices. A mesh with non-finite positions is left unchanged.
void refine_mesh(MeshData& mesh, float edge, int times);

struct RefinedShape {
    MeshId mesh;
    float edge = 0.001f;
    int times = 2;
};

LIMN_FIELDS(RefinedShape) {
    LIMN_FIELD(mesh, "the mesh to refine, by name; must come earlier in the file");
    LIMN_FIELD(
        edge, "longer edges are halved; a quarter of the width of a fold or less", "m", 1e-5, 10);
    LIMN_FIELD(times, "maximum number of subdivisions", "", 0, 5);
}

/// A refined copy of another mesh of the level, with its skin weights, morph targets and regions.
/// Empty without a mesh.
[[nodiscard]] MeshData make_refined(const RefinedShape& shape, const Assets& assets);

}  // namespace limn
