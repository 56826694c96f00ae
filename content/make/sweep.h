#pragma once

#include "ecs/components/path.h"
#include "ecs/components/surface.h"

#include <vector>

namespace limn {

/// A profile drawn along a path: roads, rails, curbs, cables, tubes of neon. Seen along the path,
/// profile points are (right, up); from left to right they make a surface that faces up. Texture
/// coordinates are meters: u along the profile, v back along the path.
struct SweepShape {
    PathId path;  ///< none: 10 m along +z
    /// At least two points [m], unless there is a radius.
    std::vector<Vec2> profile = {{-1.0f, 0.0f}, {1.0f, 0.0f}};
    float radius = 0.0f;  ///< > 0: a tube of this radius instead [m]
    int segments = 12;    ///< around a tube, >= 3
    bool closed = false;  ///< the last point of the profile is joined to the first
    float crease = 0.6f;  ///< where the profile turns by more, there is an edge [rad], 0 .. pi
    float begin = 0.0f;   ///< distance along the path [m], >= 0
    float end = 0.0f;     ///< [m]; not after `begin`: the path's end
    float step = 2.0f;    ///< from row to row [m], > 0
    float dash = 0.0f;    ///< > 0: so long a piece [m],
    float gap = 0.0f;     ///< and so long none [m]
    bool upright = true;  ///< level but for the path's roll; else it turns as little as can be
    bool caps = true;     ///< closed profiles have ends
};

[[nodiscard]] MeshData make_sweep(const SweepShape& shape, const Assets& assets);

template <typename Visitor>
void visit_fields(SweepShape& shape, Visitor&& visit) {
    visit("path", shape.path, {.doc = "a path of the level, by name; none: 10 m along +z"});
    visit("profile", shape.profile, {.doc = "points right and up of the path", .unit = "m"});
    visit(
        "radius", shape.radius,
        {.doc = "of a tube, instead of the profile", .unit = "m", .min = 0, .max = 1e4});
    visit("segments", shape.segments, {.doc = "around a tube", .min = 3, .max = 512});
    visit("closed", shape.closed, {.doc = "the profile's last point is joined to its first"});
    visit(
        "crease", shape.crease,
        {.doc = "where the profile turns by more, there is an edge",
         .unit = "rad",
         .min = 0,
         .max = 3.2});
    visit("begin", shape.begin, {.doc = "along the path", .unit = "m", .min = 0, .max = 1e6});
    visit(
        "end", shape.end,
        {.doc = "along the path; not after begin: its end", .unit = "m", .min = 0, .max = 1e6});
    visit("step", shape.step, {.doc = "from row to row", .unit = "m", .min = 0.001, .max = 1e4});
    visit("dash", shape.dash, {.doc = "length of a piece; 0 = one", .unit = "m", .min = 0});
    visit("gap", shape.gap, {.doc = "between pieces", .unit = "m", .min = 0});
    visit("upright", shape.upright, {.doc = "level but for the path's roll"});
    visit("caps", shape.caps, {.doc = "closed profiles have ends"});
}

}  // namespace limn
