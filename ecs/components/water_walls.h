#pragma once

#include "ecs/base/math.h"
#include "ecs/components/transform.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

enum class WallShape : std::uint8_t {
    Box,
    Cylinder,  ///< about its own y axis
    Ball,      ///< or an ellipsoid
};

/// An entity that stands in the water: a column, a step, an island. Where it cuts the rest surface
/// there is no water, and ripples run back from it. Where it moves to, water makes room.
struct WaterWall {
    WallShape shape = WallShape::Box;
    Vec3 half = {0.5f, 0.5f, 0.5f};  ///< half extents in its own space [m]
    Vec3 offset = {0, 0, 0};         ///< of its middle in its own space [m]
};

/// A wall as a body of water has it.
struct PlacedWall {
    WallShape shape = WallShape::Box;
    Affine shape_from_water;  ///< the shape fills -1 .. 1
    Vec2 center = {0, 0};     ///< in the water's own space, x and z [m]
    Vec2 reach = {0, 0};      ///< as far as it is from there along x and z [m]
    float volume = 0;         ///< below the rest surface and above the bottom [m^3]
};

template <typename Visitor>
void visit_fields(WaterWall& wall, Visitor&& visit) {
    visit("shape", wall.shape, {.doc = "what keeps the water out", .values = "box cylinder ball"});
    visit(
        "half", wall.half,
        {.doc = "half extents in its own space", .unit = "m", .min = 0.001, .max = 10000});
    visit("offset", wall.offset, {.doc = "of its middle in its own space", .unit = "m"});
}

template <typename Visitor>
void visit_fields(PlacedWall& wall, Visitor&& visit) {
    visit("shape", wall.shape, {.doc = "of the wall", .values = "box cylinder ball"});
    visit("x", wall.shape_from_water.row[0], {.doc = "of the shape, from the water's own space"});
    visit("y", wall.shape_from_water.row[1], {.doc = "the same"});
    visit("z", wall.shape_from_water.row[2], {.doc = "the same"});
    visit("center", wall.center, {.doc = "x and z in the water's own space", .unit = "m"});
    visit("reach", wall.reach, {.doc = "from there along x and z", .unit = "m"});
    visit("volume", wall.volume, {.doc = "under water", .unit = "m^3"});
}

}  // namespace limn
