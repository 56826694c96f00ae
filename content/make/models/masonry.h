#pragma once

#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// Parts of Gothic buildings: pointed arches, walls with an opening, vaults. All three share one
// curve, so that a vault fits its ribs and an arch its opening. They are closed 2-manifolds without
// T-junctions, edges are sharp, and texture coordinates are meters: a material with
// "tiling": [0.5, 0.5] repeats every two meters. Otherwise as shapes.h.
//
// The curve is two circular arcs that meet in a point. `radius` is that of the arcs divided by the
// span: 0.5 is a half circle, 1 an equilateral arch, more a lancet; the curve is then stretched to
// its rise. 0 selects the arcs that fit this span and rise without stretching, if there are any
// (rise >= span / 2), else the half circle.

/// A rib or frame along the curve, on two straight legs. The curve is its inner outline and begins
/// at y = 0; the legs are below.
struct ArchShape {
    float span = 2.0f;
    float rise = 1.7f;
    float radius = 0.0f;
    float legs = 0.0f;
    float thickness = 0.3f;
    float depth = 0.4f;
    float chamfer = 0.0f;
    int segments = 12;
};

LIMN_FIELDS(ArchShape) {
    LIMN_FIELD(span, "between the legs", "m", 1e-3, 1e4);
    LIMN_FIELD(rise, "height of the curve", "m", 1e-3, 1e4);
    LIMN_FIELD(
        radius, "of the two arcs / span: 0.5 half circle, 1 equilateral; 0 = fit span and rise", "",
        0, 4);
    LIMN_FIELD(legs, "straight parts below the curve", "m", 0, 1e4);
    LIMN_FIELD(thickness, "outwards from the curve", "m", 1e-3, 1e4);
    LIMN_FIELD(depth, "along z", "m", 1e-3, 1e4);
    LIMN_FIELD(chamfer, "cut off the two inner edges", "m", 0, 1e4);
    LIMN_FIELD(segments, "of one of the two arcs", "", 1, 512);
}

/// A wall that stands on y = 0, with one opening: pointed, on the ground or on a sill; or round.
struct MasonryWall {
    Vec3 size = {4, 5, 0.6f};
    float span = 2.8f;
    float spring = 2.0f;
    float rise = 2.2f;
    float radius = 0.0f;
    float sill = 0.0f;
    bool round = false;
    int segments = 12;
};

LIMN_FIELDS(MasonryWall) {
    LIMN_FIELD(size, "width, height and thickness", "m", 1e-2, 1e4);
    LIMN_FIELD(span, "width of the opening, less than the wall's", "m", 1e-3, 1e4);
    LIMN_FIELD(spring, "height where the curve begins; center of a round opening", "m", 0, 1e4);
    LIMN_FIELD(rise, "height of the curve; ignored if round", "m", 1e-3, 1e4);
    LIMN_FIELD(
        radius, "of the two arcs / span: 0.5 half circle, 1 equilateral; 0 = fit span and rise", "",
        0, 4);
    LIMN_FIELD(sill, "height of the sill of a pointed opening; 0 = on the ground", "m", 0, 1e4);
    LIMN_FIELD(round, "the opening is a circle");
    LIMN_FIELD(segments, "of one of the two arcs", "", 1, 512);
}

/// A vault over a rectangle: two intersecting pointed barrel vaults of the same height. Its webs
/// spring from y = 0 at the four corners; ribs are separate arches (span of the diagonal, same rise
/// and radius).
struct VaultShape {
    Vec2 size = {4, 4};
    float rise = 2.4f;
    float radius = 1.0f;
    float thickness = 0.15f;
    int segments = 10;
};

LIMN_FIELDS(VaultShape) {
    LIMN_FIELD(size, "along x and z", "m", 1e-2, 1e4);
    LIMN_FIELD(rise, "from the corners to the center", "m", 1e-3, 1e4);
    LIMN_FIELD(radius, "of the arcs / span, then stretched: 0.5 round, 1 equilateral", "", 0.5, 4);
    LIMN_FIELD(thickness, "upwards", "m", 1e-3, 1e4);
    LIMN_FIELD(segments, "from a corner to the center", "", 1, 256);
}

[[nodiscard]] MeshData make_arch(const ArchShape& shape);
[[nodiscard]] MeshData make_wall(const MasonryWall& shape);
[[nodiscard]] MeshData make_vault(const VaultShape& shape);

/// A point on the right half of a curve that is symmetric about x = 0.
struct CurvePoint {
    Vec2 position;  ///< [m]
    Vec2 normal;    ///< outwards, unit
};

/// `segments` + 1 points from (span / 2, 0) to (0, rise), at equal angles of the arc.
[[nodiscard]] std::vector<CurvePoint>
pointed_curve(float span, float rise, float radius, int segments);

}  // namespace limn
