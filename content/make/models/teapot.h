#pragma once

#include "content/make/models/bezier_patch.h"

#include <cstdint>
#include <vector>

namespace limn {

// The teapot of Martin Newell (1975): 32 bicubic patches. Rim, body, lid and bottom are revolved
// about the vertical axis, with quarter circles whose handle factor is 0.56 (0.41 % off a circle;
// the knob of the lid has 0.5625 in the public data); handle and spout are ducts, mirrored left and
// right. The original had no bottom: its 4 patches are the later addition, on by default so that
// the pot may be viewed from below.
//
// Here +y is up, the spout points along +x, and u x v points outwards everywhere. Handle and spout
// end inside the body and are not stitched to it.

enum class TeapotPart : std::uint8_t { Rim, Body, Lid, Bottom, Handle, Spout };

/// One patch in the units of the data: the pot is 3.15 high and stands on y = 0.
struct TeapotPatch {
    TeapotPart part;
    BezierPatch surface;
    Vec2 uv_at_start;  ///< texture coordinates at u = v = 0 ...
    Vec2 uv_at_end;    ///< ... and at u = v = 1; they grow to the right and downwards
};

struct TeapotShape {
    int divisions = 10;
    float tolerance = 0.0f;
    int level = -1;
    float height = 1.0f;
    bool bottom = true;
};

LIMN_FIELDS(TeapotShape) {
    LIMN_FIELD(divisions, "quads along each side of the 32 patches", "", 1, 128);
    LIMN_FIELD(
        tolerance, "if not 0: adaptive tessellation with this error, instead of divisions", "m", 0,
        10);
    LIMN_FIELD(
        level,
        "if >= 0: this level of the patches' hierarchy, 4^level flat pieces of each, instead "
        "of divisions",
        "", -1, 7);
    LIMN_FIELD(height, "with the lid", "m", 1e-4, 1e5);
    LIMN_FIELD(bottom, "closed from below");
}

/// 28 patches, or 32 with the bottom: rim 4, body 8, lid 8, handle 4, spout 4, bottom 4.
[[nodiscard]] std::vector<TeapotPatch> teapot_patches(bool bottom);

/// Stands on y = 0. Uniform: divisions^2 quads per patch, two triangles each; those at the center
/// of lid and bottom, where a side of a patch is a point, have no area but do have normals. The
/// texture goes four times around the body and once around handle and spout.
[[nodiscard]] MeshData make_teapot(const TeapotShape& shape);

}  // namespace limn
