#pragma once

#include "ecs/base/math.h"
#include "ecs/components/water_walls.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Ripples of a body of water: a height field that obeys the wave equation, driven by impulses and
// by objects in the water.

enum class RippleBorder : std::uint8_t {
    Reflecting,  ///< walls
    Absorbing,   ///< open water: waves leave without reflection
};

/// With a Water: simulates ripples on a grid over its rectangle, or over `window`.
struct WaterRipples {
    float cell = 0.05f;  ///< cell size of the grid [m]; raised if there would be too many cells
    float speed = 1.2f;  ///< wave speed [m/s]; at most half a cell per substep
    float damping = 0.4f;
    RippleBorder border = RippleBorder::Reflecting;
    Vec2 window = {0, 0};
    float rain = 0;
    float rain_height = 0.01f;
};

LIMN_FIELDS(WaterRipples) {
    LIMN_FIELD(cell, "cell size of the grid", "m", 0.002, 100);
    LIMN_FIELD(speed, "wave speed", "m/s", 0, 1000);
    LIMN_FIELD(damping, "decay rate of waves", "1/s", 0, 100);
    LIMN_FIELD(border, .doc = "reflecting walls, or open water", .values = "reflecting absorbing");
    LIMN_FIELD(window, "simulated area of unbounded water", "m", 0, 10000);
    LIMN_FIELD(rain, "rain drops per area and time", "1/(m^2 s)", 0, 10000);
    LIMN_FIELD(rain_height, "crest height raised by a drop", "m", 0, 1);
}

/// An impact, or its reverse: pushes the water down in a disc and up around it, conserving volume.
struct RippleImpulse {
    Vec2 center = {0, 0};
    float radius = 0.2f;
    float height = -0.05f;
};

LIMN_FIELDS(RippleImpulse) {
    LIMN_FIELD(center, "center, x and z in the water's local space", "m");
    LIMN_FIELD(radius, "radius of the whole disturbance", "m", 0, 1000);
    LIMN_FIELD(height, "height at the center; negative: down", "m", -100, 100);
}

/// Weighted contribution of a neighbor to a cell, both given as array indices.
struct RippleLink {
    std::uint32_t at = 0;
    std::uint32_t other = 0;
    float weight = 0;
};

/// With a WaterRipples: the simulation state, created and stepped by the systems. Rows run along x
/// and are stacked along z, with a border of one cell, which is not water, around the grid.
struct RippleState {
    IVec2 cells = {0, 0};
    std::int32_t stride = 0;
    float cell = 0;
    std::int32_t substeps = 0;
    float substep = 0;
    std::vector<float> height;  ///< above rest, (cells.y + 2) * stride [m]
    std::vector<float> previous;
    std::vector<float> body;  ///< height due to submerged bodies [m]; empty if there are none
    std::vector<RippleImpulse> impulses;  ///< queue for the next step; others append
    double level = 0;
    std::uint32_t steps = 0;
    std::uint32_t dropped = 0;
    std::int32_t wet = 0;

    // Walls in the water; all empty if there are none.
    std::vector<PlacedWall> walls;
    RippleBorder wall_border = RippleBorder::Reflecting;
    std::vector<std::uint8_t> dry;       ///< 1 in wall cells; one byte per height
    std::vector<RippleLink> faces;       ///< corrections of the Laplacian at walls, row by row
    std::vector<std::uint32_t> row;      ///< start of each row in `faces`, then their number
    std::vector<RippleLink> wall_cells;  ///< wall cells that copy the water next to them
    double wall_volume = 0;

    /// Array index of cell (x, z); -1 and `cells` are the border.
    [[nodiscard]] std::size_t at(int x, int z) const {
        return static_cast<std::size_t>(z + 1) * static_cast<std::size_t>(stride)
               + static_cast<std::size_t>(x + 1);
    }
    /// Extent of the grid, which is centered on the water's local origin [m].
    [[nodiscard]] Vec2 size() const { return cell * Vec2(cells); }
};

LIMN_FIELDS(RippleState) {
    LIMN_FIELD(cells, "grid size, without its border");
    LIMN_FIELD(stride, "stride of rows in floats");
    LIMN_FIELD(cell, "cell size", "m");
    LIMN_FIELD(substeps, "substeps per step");
    LIMN_FIELD(substep, "length of a substep", "s");
    LIMN_FIELD(height, "heights above rest", "m");
    LIMN_FIELD(
        previous, .doc = "heights of the previous substep", .unit = "m", .renamed = "before");
    LIMN_FIELD(body, "height due to submerged bodies", "m");
    LIMN_FIELD(impulses, "impulses for the next step");
    LIMN_FIELD(level, "mean height due to bodies and walls", "m");
    LIMN_FIELD(steps, "steps since creation");
    LIMN_FIELD(dropped, "impulses dropped over budget");
    LIMN_FIELD(wet, "number of cells outside walls");
    LIMN_FIELD(walls, "walls in the water");
    LIMN_FIELD(
        wall_border, .doc = "border for which the wall corrections were built",
        .values = "reflecting absorbing");
    LIMN_FIELD(dry, "1 in wall cells");
    LIMN_FIELD(wall_volume, .doc = "volume displaced by walls", .unit = "m^3", .renamed = "walled");
}

enum class TouchShape : std::uint8_t {
    Ball,
    Box,
    Mesh,  ///< ellipsoids fitted to the mesh, per joint if it is skinned; `half` is used only as
           ///< the box of a Floating on the same entity
};

/// An entity that displaces water where it is submerged.
struct WaterTouch {
    TouchShape shape = TouchShape::Ball;
    Vec3 half = {0.25f, 0.25f, 0.25f};
    Vec3 offset = {0, 0, 0};
};

LIMN_FIELDS(WaterTouch) {
    LIMN_FIELD(shape, .doc = "shape that displaces water", .values = "ball box mesh");
    LIMN_FIELD(half, "half extents in local space; a ball uses x", "m", 0.001, 10000);
    LIMN_FIELD(offset, "offset of its center in local space", "m");
}

/// One ellipsoid that approximates part of a mesh, in the undeformed mesh's space.
struct TouchPart {
    std::int32_t joint = -1;
    Vec3 center = {0, 0, 0};
    Vec3 half = {0, 0, 0};
};

LIMN_FIELDS(TouchPart) {
    LIMN_FIELD(joint, "joint of the skin that moves it; -1: none");
    LIMN_FIELD(center, "center in the undeformed mesh's space", "m");
    LIMN_FIELD(half, "half extents of the ellipsoid", "m");
}

/// With a WaterTouch of shape Mesh: derived from the mesh.
struct TouchParts {
    std::vector<TouchPart> parts;
    float fill = 1;
    std::int32_t mesh = -1;
    std::int32_t skin = -1;
};

LIMN_FIELDS(TouchParts) {
    LIMN_FIELD(parts, "ellipsoids");
    LIMN_FIELD(fill, "volume of the mesh divided by that of the ellipsoids");
    LIMN_FIELD(mesh, "index of the mesh they were made from", "", -1);
    LIMN_FIELD(skin, "index of its skin; -1: none", "", -1);
}

template <>
struct ComponentTraits<TouchParts> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// Instances of a prefab start at rest.
template <>
struct ComponentTraits<RippleState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
