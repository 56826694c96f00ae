#pragma once

#include "ecs/base/math.h"
#include "ecs/components/water_walls.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Ripples of a body of water: a height field that obeys the wave equation, moved by impulses and by
// what touches the water.

enum class RippleBorder : std::uint8_t {
    Reflecting,  ///< walls: the water stays in
    Absorbing,   ///< open: waves leave, none come back
};

/// Beside a Water: simulates ripples on a grid over its rectangle, or over `window`.
struct WaterRipples {
    float cell = 0.05f;  ///< side of a square of the grid [m]; grows where there would be too many
    float speed = 1.2f;  ///< of the waves [m/s]; at most half of a cell a sub-step
    float damping = 0.4f;  ///< waves fade by exp(-damping t) [1/s]
    RippleBorder border = RippleBorder::Reflecting;
    Vec2 window = {0, 0};       ///< of water without end: what part about the entity ripples [m]
    float rain = 0;             ///< drops that fall on it [1/(m^2 s)]
    float rain_height = 0.01f;  ///< of the crest that a drop throws up [m]
};

/// Something falls in, or is pulled out: pushes the water down in a disc and up around it, so that
/// none is made or lost.
struct RippleImpulse {
    Vec2 center = {0, 0};   ///< in the water's own space, x and z [m]
    float radius = 0.2f;    ///< of the whole disturbance [m], > 0
    float height = -0.05f;  ///< of the middle [m]; negative: down
};

/// Two cells, by their places in the arrays: a neighbor's share in what happens to the first.
struct RippleLink {
    std::uint32_t at = 0;
    std::uint32_t other = 0;
    float weight = 0;
};

/// Beside a WaterRipples, made and stepped by the systems. Rows run along x, one after another
/// along z; around the grid lies a border of one cell, which is no water.
struct RippleState {
    IVec2 cells = {0, 0};       ///< of the grid, without its border
    std::int32_t stride = 0;    ///< floats from row to row
    float cell = 0;             ///< side of a square [m]
    std::int32_t substeps = 0;  ///< in a step
    float substep = 0;          ///< [s]
    std::vector<float> height;  ///< above rest, (cells.y + 2) * stride [m]
    std::vector<float> before;  ///< one sub-step earlier
    std::vector<float> body;    ///< what bodies under water make of it; empty where there are none
    std::vector<RippleImpulse> impulses;  ///< of the next step; others add to it
    double level = 0;                     ///< mean height that bodies and walls make [m]
    std::uint32_t steps = 0;              ///< since it was made
    std::uint32_t dropped = 0;            ///< impulses that were too many, since it was made
    std::int32_t wet = 0;                 ///< cells that are no wall

    // What stands in it; all empty where nothing does.
    std::vector<PlacedWall> walls;
    RippleBorder wall_border = RippleBorder::Reflecting;  ///< that `faces` are made for
    std::vector<std::uint8_t> dry;   ///< 1 of a cell that is wall, a byte for each height
    std::vector<RippleLink> faces;   ///< what walls change of the Laplacian, row by row
    std::vector<std::uint32_t> row;  ///< the first of `faces` of each row, and their number
    std::vector<RippleLink> rims;    ///< cells of walls repeat what is before them
    double walled = 0;               ///< what walls have displaced since it was made [m^3]

    /// Place of cell (x, z) in the arrays; -1 and `cells` are the border.
    [[nodiscard]] std::size_t at(int x, int z) const {
        return static_cast<std::size_t>(z + 1) * static_cast<std::size_t>(stride)
               + static_cast<std::size_t>(x + 1);
    }
    /// Of the grid, which the water's own origin is the middle of [m].
    [[nodiscard]] Vec2 size() const { return cell * Vec2(cells); }
};

enum class TouchShape : std::uint8_t {
    Ball,
    Box,
    Mesh,  ///< what its mesh is, joint by joint where a pose moves it; of `half` it
           ///< has nothing, but what is Floating beside it floats as a box of that
};

/// An entity that pushes water aside where it is in it.
struct WaterTouch {
    TouchShape shape = TouchShape::Ball;
    Vec3 half = {0.25f, 0.25f, 0.25f};  ///< half extents in its own space; of a ball x [m]
    Vec3 offset = {0, 0, 0};            ///< of its middle in its own space [m]
};

/// An ellipsoid of a mesh that touches the water, in the mesh's space at rest.
struct TouchPart {
    std::int32_t joint = -1;  ///< of the skin, that moves it; -1: none
    Vec3 center = {0, 0, 0};  ///< [m]
    Vec3 half = {0, 0, 0};    ///< [m]
};

/// Beside a WaterTouch of a mesh: follows from it.
struct TouchParts {
    std::vector<TouchPart> parts;
    float fill = 1;          ///< volume of the mesh over that of the ellipsoids
    std::int32_t mesh = -1;  ///< whose they are: its index
    std::int32_t skin = -1;  ///< by which: its index, -1: none
};

template <>
struct ComponentTraits<TouchParts> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// A pool of a prefab begins at rest.
template <>
struct ComponentTraits<RippleState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

template <typename Visitor>
void visit_fields(WaterRipples& ripples, Visitor&& visit) {
    visit(
        "cell", ripples.cell,
        {.doc = "side of a square of the grid", .unit = "m", .min = 0.002, .max = 100});
    visit("speed", ripples.speed, {.doc = "of the waves", .unit = "m/s", .min = 0, .max = 1000});
    visit(
        "damping", ripples.damping,
        {.doc = "how fast they fade", .unit = "1/s", .min = 0, .max = 100});
    visit(
        "border", ripples.border,
        {.doc = "walls, or open water", .values = "reflecting absorbing"});
    visit(
        "window", ripples.window,
        {.doc = "part that ripples of water without end", .unit = "m", .min = 0, .max = 10000});
    visit(
        "rain", ripples.rain,
        {.doc = "drops that fall on it", .unit = "1/(m^2 s)", .min = 0, .max = 10000});
    visit(
        "rain_height", ripples.rain_height,
        {.doc = "of the crest of a drop", .unit = "m", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(RippleImpulse& impulse, Visitor&& visit) {
    visit("center", impulse.center, {.doc = "x and z in the water's own space", .unit = "m"});
    visit(
        "radius", impulse.radius,
        {.doc = "of the whole disturbance", .unit = "m", .min = 0, .max = 1000});
    visit(
        "height", impulse.height,
        {.doc = "of the middle; negative: down", .unit = "m", .min = -100, .max = 100});
}

template <typename Visitor>
void visit_fields(RippleState& state, Visitor&& visit) {
    visit("cells", state.cells, {.doc = "of the grid"});
    visit("stride", state.stride, {.doc = "floats from row to row"});
    visit("cell", state.cell, {.doc = "side of a square", .unit = "m"});
    visit("substeps", state.substeps, {.doc = "in a step"});
    visit("substep", state.substep, {.doc = "how long each is", .unit = "s"});
    visit("height", state.height, {.doc = "above rest", .unit = "m"});
    visit("before", state.before, {.doc = "one sub-step earlier", .unit = "m"});
    visit("body", state.body, {.doc = "what bodies under water make of it", .unit = "m"});
    visit("impulses", state.impulses, {.doc = "of the next step"});
    visit("level", state.level, {.doc = "mean height that bodies and walls make", .unit = "m"});
    visit("steps", state.steps, {.doc = "since it was made"});
    visit("dropped", state.dropped, {.doc = "impulses that were too many"});
    visit("wet", state.wet, {.doc = "cells that are no wall"});
    visit("walls", state.walls, {.doc = "that stand in it"});
    visit(
        "wall_border", state.wall_border,
        {.doc = "that the faces are made for", .values = "reflecting absorbing"});
    visit("dry", state.dry, {.doc = "1 of cells that are wall"});
    visit("walled", state.walled, {.doc = "what walls have displaced", .unit = "m^3"});
}

template <typename Visitor>
void visit_fields(TouchPart& part, Visitor&& visit) {
    visit("joint", part.joint, {.doc = "of the skin, that moves it; -1: none"});
    visit("center", part.center, {.doc = "in the mesh's space at rest", .unit = "m"});
    visit("half", part.half, {.doc = "half extents of the ellipsoid", .unit = "m"});
}

template <typename Visitor>
void visit_fields(TouchParts& parts, Visitor&& visit) {
    visit("parts", parts.parts, {.doc = "the ellipsoids"});
    visit("fill", parts.fill, {.doc = "volume of the mesh over theirs"});
    visit("mesh", parts.mesh, {.doc = "whose they are: its index", .min = -1});
    visit("skin", parts.skin, {.doc = "by which: its index, -1: none", .min = -1});
}

template <typename Visitor>
void visit_fields(WaterTouch& touch, Visitor&& visit) {
    visit("shape", touch.shape, {.doc = "what pushes the water aside", .values = "ball box mesh"});
    visit(
        "half", touch.half,
        {.doc = "half extents in its own space; of a ball x",
         .unit = "m",
         .min = 0.001,
         .max = 10000});
    visit("offset", touch.offset, {.doc = "of its middle in its own space", .unit = "m"});
}

}  // namespace limn
