#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Resource: light that the lens scatters about everything bright. Absent, or of strength 0: none.
/// There is no threshold: every pixel gives the same share of its light, which is what glass does,
/// and no light is made or lost.
struct Glow {
    float strength = 0.08f;  ///< share of the light that is scattered, 0 .. 1
    float radius = 0.15f;    ///< standard deviation of the widest scattering, of the height
    float falloff = 2.4f;    ///< light falls with this power of the distance, 1 .. 4
    float firefly =
        100.0f;  ///< luminance from which on lone pixels glow no more; 0 = no such limit

    bool operator==(const Glow&) const = default;
};

template <typename Visitor>
void visit_fields(Glow& glow, Visitor&& visit) {
    visit(
        "strength",
        glow.strength,
        {.doc = "share of the light that the lens scatters", .min = 0, .max = 1});
    visit(
        "radius",
        glow.radius,
        {.doc = "of the widest scattering, as a share of the picture's height",
         .min = 0.001,
         .max = 1});
    visit(
        "falloff",
        glow.falloff,
        {.doc = "scattered light falls with this power of the distance", .min = 1, .max = 4});
    visit(
        "firefly",
        glow.firefly,
        {.doc = "luminance from which on lone pixels glow no more; 0 = no such limit",
         .min = 0,
         .max = 65504});
}

}  // namespace limn
