#pragma once

#include "ecs/components/surface.h"

#include <vector>

namespace limn {

// What Gothic buildings are put together from: pointed arches, walls with an opening, vaults. All
// three take their shape from one curve, so that a vault lies on its ribs and an arch fits its
// opening. They are closed two-manifolds without T-junctions, edges are sharp, and texture
// coordinates are meters: a material with "tiling": [0.5, 0.5] shows its image every two meters
// everywhere. Otherwise as shapes.h.
//
// The curve is two arcs of a circle that meet in a point. `radius` is that of the arcs in spans:
// 0.5 makes a half circle, 1 an equilateral arch, more a lancet; the curve is then stretched to
// its rise. 0 takes the arcs that have this span and rise without stretching, if there are any
// (rise >= span / 2), else the half circle.

/// A rib or frame that follows the curve, on two straight legs. The curve is its inner outline; it
/// begins at y = 0, the legs end below.
struct ArchShape {
    float span = 2.0f;       ///< between the legs [m], > 0
    float rise = 1.7f;       ///< from where the curve begins to its point [m], > 0
    float radius = 0.0f;     ///< of the arcs in spans, 0 or 0.5 .. 4
    float legs = 0.0f;       ///< length of the straight legs [m], >= 0
    float thickness = 0.3f;  ///< outwards in the plane of the curve [m], > 0
    float depth = 0.4f;      ///< across it [m], > 0
    float chamfer = 0.0f;    ///< cut off the two inner edges [m], < thickness, < depth / 2
    int segments = 12;       ///< of one arc, >= 1
};

/// A wall that stands on y = 0, with one opening: pointed, on the ground or on a sill; or round.
struct WallShape {
    Vec3 size = {4, 5, 0.6f};  ///< width, height, thickness [m], > 0
    float span = 2.8f;         ///< width of the opening [m], < width
    float spring = 2.0f;       ///< where the curve begins, or the middle of a round one [m]
    float rise = 2.2f;         ///< from there to the point [m]; not of a round one
    float radius = 0.0f;       ///< of the arcs in spans, 0 or 0.5 .. 4
    float sill = 0.0f;         ///< where the opening begins [m]; 0 = on the ground
    bool round = false;        ///< a circle of diameter `span`
    int segments = 12;         ///< of one arc, >= 1; a circle has four times as many
};

/// A vault over a rectangle: two pointed tunnels of the same height that cross. Its webs spring
/// from y = 0 at the four corners; ribs are arches of their own (span of the diagonal, same rise
/// and radius).
struct VaultShape {
    Vec2 size = {4, 4};       ///< along x and z [m], > 0
    float rise = 2.4f;        ///< from the corners to the middle [m], > 0
    float radius = 1.0f;      ///< of the arcs in spans, 0.5 .. 4; stretched to span and rise
    float thickness = 0.15f;  ///< upwards [m], > 0
    int segments = 10;        ///< from a corner to the middle, >= 1
};

[[nodiscard]] MeshData make_arch(const ArchShape& shape);
[[nodiscard]] MeshData make_wall(const WallShape& shape);
[[nodiscard]] MeshData make_vault(const VaultShape& shape);

/// The right half of a curve about x = 0.
struct CurvePoint {
    Vec2 place;   ///< [m]
    Vec2 normal;  ///< outwards, unit
};

/// `segments` + 1 points from (span / 2, 0) to (0, rise), by equal angles of the arc.
[[nodiscard]] std::vector<CurvePoint>
pointed_curve(float span, float rise, float radius, int segments);

template <typename Visitor>
void visit_fields(ArchShape& shape, Visitor&& visit) {
    visit("span", shape.span, {.doc = "between the legs", .unit = "m", .min = 1e-3, .max = 1e4});
    visit(
        "rise", shape.rise,
        {.doc = "from where the curve begins to its point", .unit = "m", .min = 1e-3, .max = 1e4});
    visit(
        "radius", shape.radius,
        {.doc = "of the two arcs in spans: 0.5 a half circle, 1 equilateral; 0 = by span and rise",
         .min = 0,
         .max = 4});
    visit(
        "legs", shape.legs,
        {.doc = "straight parts below the curve", .unit = "m", .min = 0, .max = 1e4});
    visit(
        "thickness", shape.thickness,
        {.doc = "outwards from the curve", .unit = "m", .min = 1e-3, .max = 1e4});
    visit("depth", shape.depth, {.doc = "along z", .unit = "m", .min = 1e-3, .max = 1e4});
    visit(
        "chamfer", shape.chamfer,
        {.doc = "cut off the two inner edges", .unit = "m", .min = 0, .max = 1e4});
    visit("segments", shape.segments, {.doc = "of one of the two arcs", .min = 1, .max = 512});
}

template <typename Visitor>
void visit_fields(WallShape& shape, Visitor&& visit) {
    visit(
        "size", shape.size,
        {.doc = "width, height and thickness", .unit = "m", .min = 1e-2, .max = 1e4});
    visit(
        "span", shape.span,
        {.doc = "width of the opening, less than the wall's",
         .unit = "m",
         .min = 1e-3,
         .max = 1e4});
    visit(
        "spring", shape.spring,
        {.doc = "where the curve begins; the middle of a round opening",
         .unit = "m",
         .min = 0,
         .max = 1e4});
    visit(
        "rise", shape.rise,
        {.doc = "from there to the point", .unit = "m", .min = 1e-3, .max = 1e4});
    visit(
        "radius", shape.radius,
        {.doc = "of the two arcs in spans: 0.5 a half circle, 1 equilateral; 0 = by span and rise",
         .min = 0,
         .max = 4});
    visit(
        "sill", shape.sill,
        {.doc = "where a pointed opening begins; 0 = on the ground",
         .unit = "m",
         .min = 0,
         .max = 1e4});
    visit("round", shape.round, {.doc = "the opening is a circle"});
    visit("segments", shape.segments, {.doc = "of one of the two arcs", .min = 1, .max = 512});
}

template <typename Visitor>
void visit_fields(VaultShape& shape, Visitor&& visit) {
    visit("size", shape.size, {.doc = "along x and z", .unit = "m", .min = 1e-2, .max = 1e4});
    visit(
        "rise", shape.rise,
        {.doc = "from the corners to the middle", .unit = "m", .min = 1e-3, .max = 1e4});
    visit(
        "radius", shape.radius,
        {.doc = "of the arcs in spans, then stretched: 0.5 round, 1 equilateral",
         .min = 0.5,
         .max = 4});
    visit("thickness", shape.thickness, {.doc = "upwards", .unit = "m", .min = 1e-3, .max = 1e4});
    visit("segments", shape.segments, {.doc = "from a corner to the middle", .min = 1, .max = 256});
}

}  // namespace limn
