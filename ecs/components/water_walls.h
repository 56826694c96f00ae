#pragma once

#include "ecs/base/math.h"
#include "ecs/components/transform.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

enum class WallShape : std::uint8_t {
    Box,
    Cylinder,  ///< about its local y axis
    Ball,      ///< or an ellipsoid
};

/// A solid obstacle in the water: a column, a step, an island. Its section with the rest surface
/// contains no water and reflects ripples. As it moves, it displaces water.
struct WaterWall {
    WallShape shape = WallShape::Box;
    Vec3 half = {0.5f, 0.5f, 0.5f};
    Vec3 offset = {0, 0, 0};
};

LIMN_FIELDS(WaterWall) {
    LIMN_FIELD(shape, .doc = "shape of the obstacle", .values = "box cylinder ball");
    LIMN_FIELD(half, "half extents in local space", "m", 0.001, 10000);
    LIMN_FIELD(offset, "offset of its center in local space", "m");
}

/// A wall in the local space of a body of water.
struct PlacedWall {
    WallShape shape = WallShape::Box;
    Affine shape_from_water;    ///< the shape fills -1 .. 1
    Vec2 center = {0, 0};       ///< in the water's local space, x and z [m]
    Vec2 half_extent = {0, 0};  ///< half extents along the water's x and z [m]
    float volume = 0;           ///< between the rest surface and the bottom [m^3]
};

template <typename Visitor>
void visit_fields(PlacedWall& wall, Visitor&& visit) {
    visit("shape", wall.shape, {.doc = "shape of the wall", .values = "box cylinder ball"});
    visit(
        "x", wall.shape_from_water.row[0],
        {.doc = "row x of the matrix from the water's space to -1 .. 1"});
    visit("y", wall.shape_from_water.row[1], {.doc = "row y of that matrix"});
    visit("z", wall.shape_from_water.row[2], {.doc = "row z of that matrix"});
    visit(
        "center", wall.center, {.doc = "center, x and z in the water's local space", .unit = "m"});
    visit(
        "half_extent", wall.half_extent,
        {.doc = "half extents along the water's x and z", .unit = "m"});
    visit("volume", wall.volume, {.doc = "submerged volume", .unit = "m^3"});
}

}  // namespace limn
