#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Leaves waves behind where its entity moves through water that has WaterWaves: a ring every
/// `spacing` of the way. What a boat does to the surface.
struct WakeEmitter {
    float spacing = 1.0f;     ///< way from ring to ring [m], > 0
    float amplitude = 0.04f;  ///< of a ring when it begins [m]
    float length = 0;         ///< of its waves [m]; 0: what makes Kelvin's wedge at its speed
    std::uint32_t waves = 2;  ///< in a ring
    float decay = 3.0f;       ///< rings fade to 1/e in it, and end after three times as long [s]
    bool started = false;     ///< `last` is where it has been
    Vec2 last = {0, 0};       ///< where the last ring began, x and z of the world [m]
    Vec2 before = {0, 0};     ///< where it was a step ago [m]
};

template <typename Visitor>
void visit_fields(WakeEmitter& wake, Visitor&& visit) {
    visit(
        "spacing", wake.spacing,
        {.doc = "way from ring to ring", .unit = "m", .min = 0.01, .max = 1000});
    visit(
        "amplitude", wake.amplitude,
        {.doc = "of a ring when it begins", .unit = "m", .min = 0, .max = 10});
    visit(
        "length", wake.length,
        {.doc = "of its waves; 0: what makes Kelvin's wedge", .unit = "m", .min = 0, .max = 1000});
    visit("waves", wake.waves, {.doc = "in a ring", .min = 1, .max = 100});
    visit(
        "decay", wake.decay, {.doc = "fades to 1/e in it", .unit = "s", .min = 0.01, .max = 1000});
    visit("started", wake.started, {.doc = "last is where it has been"});
    visit("last", wake.last, {.doc = "where the last ring began", .unit = "m"});
    visit("before", wake.before, {.doc = "where it was a step ago", .unit = "m"});
}

}  // namespace limn
