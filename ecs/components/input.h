#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Resource: what the player does in this step, the same whether it comes from a window, a level's
/// timed events or a replay.
struct Input {
    Vec3 move = {0, 0, 0};     ///< wanted motion: x right, y up, z forward, each -1 .. 1
    Vec2 look = {0, 0};        ///< mouse motion [pixels]: x right, y down
    float zoom = 0.0f;         ///< wheel steps, > 0 = nearer
    bool fast = false;         ///< move faster
    Vec3 lens = {0, 0, 0};     ///< wanted turn: focus farther, aperture wider, shutter open longer,
                               ///< each -1 .. 1
    Vec3 weather = {0, 0, 0};  ///< wanted change: wind veers, gets stronger, more rain; -1 .. 1
    bool click = false;        ///< on what the pointer is on; whoever takes it makes it false
    Vec3 eye = {0, 0, 0};      ///< where the pointer is looked through from [m]
    Vec3 pointing = {0, 0, 0};  ///< from there through the pointer; 0: at nothing
};

template <typename Visitor>
void visit_fields(Input& input, Visitor&& visit) {
    visit("move", input.move, {.doc = "wanted motion: right, up, forward", .min = -1, .max = 1});
    visit("look", input.look, {.doc = "mouse motion", .unit = "pixels"});
    visit("zoom", input.zoom, {.doc = "wheel steps, > 0 = nearer"});
    visit("fast", input.fast, {.doc = "move faster"});
    visit(
        "lens", input.lens,
        {.doc = "wanted turn: focus farther, aperture wider, shutter longer", .min = -1, .max = 1});
    visit(
        "weather", input.weather,
        {.doc = "wanted change: wind veers, gets stronger, more rain", .min = -1, .max = 1});
    visit("click", input.click, {.doc = "on what the pointer is on; a stone thrown takes it"});
    visit("eye", input.eye, {.doc = "where the pointer is looked through from", .unit = "m"});
    visit("pointing", input.pointing, {.doc = "from there through the pointer; 0: at nothing"});
}

}  // namespace limn
