#pragma once

#include "content/make/models/bezier_patch.h"
#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <array>
#include <vector>

namespace limn {

// Curved architecture of biquadratic Bezier patches, as in the levels of Quake 3: a grid of control
// points, of which each 3 x 3 are a patch and neighbors share a row.
//
//     Q(u, v) = sum_ij B_i(u) B_j(v) q_ij,   B = ((1 - t)^2, 2 t (1 - t), t^2)
//
// Every one is a bicubic patch, too, by degree elevation, so that points, frames, splitting and
// triangles are those of bezier_patch.h. A quarter circle with its middle point at the corner of
// its tangents is up to 6.1 % of the radius too far out.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), appendix 7.1.
// Techniques: anim.biquadratic-patch

/// 9 control points: q[i][j], i along u, j along v. The corners lie on the surface.
struct QuadraticPatch {
    std::array<std::array<Vec3, 3>, 3> q;
};

/// The weights of the three points of a quadratic curve at t.
[[nodiscard]] Vec3 quadratic_weights(float t);

[[nodiscard]] Vec3 patch_point(const QuadraticPatch& patch, float u, float v);

/// The same surface as a bicubic patch.
[[nodiscard]] BezierPatch elevate_patch(const QuadraticPatch& patch);

/// A mesh of patches as a level describes it.
struct PatchMeshShape {
    int width = 3;
    std::vector<Vec3> points = {{-1, 0, 0}, {-1, 1, 0},  {0, 1, 0},   {-1, 0, -1}, {-1, 1, -1},
                                {0, 1, -1}, {-1, 0, -2}, {-1, 1, -2}, {0, 1, -2}};
    int divisions = 8;
    float tolerance = 0.0f;
    bool double_sided = false;
};

LIMN_FIELDS(PatchMeshShape) {
    LIMN_FIELD(width, "control points in a row, odd", "", 3, 1001);
    LIMN_FIELD(
        points,
        "control points row by row, an odd number of rows; every other one is on the "
        "surface",
        "m");
    LIMN_FIELD(divisions, "quads along each side of a patch", "", 1, 128);
    LIMN_FIELD(
        tolerance, "if not 0: adaptive tessellation with this error, instead of divisions", "m", 0,
        10);
    LIMN_FIELD(double_sided, "also seen from the other side, as a second sheet");
}

/// The patches of the grid, row by row; u goes along a row. Without a whole one: none.
[[nodiscard]] std::vector<QuadraticPatch> list_patches(const PatchMeshShape& shape);

/// Seen from the side that u x v points to. The texture goes once over each patch. A grid without a
/// whole patch is an empty mesh; points beyond the last whole row are ignored.
[[nodiscard]] MeshData make_patch_grid(const PatchMeshShape& shape);

}  // namespace limn
