#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// With a WaterTouch, which defines the shape, on an entity without a parent: falls through air,
/// floats on water, or sinks to the bottom; boxes and balls push one another. Mass is density times
/// the volume of the shape, uniformly distributed.
struct Floating {
    float density = 500.0f;
    Vec3 center_of_mass = {0, 0, 0};
    Vec3 drag = {1, 1, 1};  ///< drag coefficients along local axes; a keel has a large x
    float damping = 0.4f;
    float splash = 1.0f;
    bool confined = true;
    Vec3 velocity = {0, 0, 0};
    Vec3 spin = {0, 0, 0};
};

LIMN_FIELDS(Floating) {
    LIMN_FIELD(density, "density; water: 1000", "kg/m^3", 1, 30000);
    LIMN_FIELD(
        center_of_mass, .doc = "center of mass relative to the center of the shape, in local space",
        .unit = "m", .renamed = "balance");
    LIMN_FIELD(drag, "drag coefficients in water along local axes", "", 0, 1000);
    LIMN_FIELD(damping, "decay rate of motion relative to the water, while afloat", "1/s", 0, 100);
    LIMN_FIELD(splash, "factor on the splash height on impact; 0: no splash", "", 0, 100);
    LIMN_FIELD(confined, .doc = "cannot leave the edges of the water it is in", .renamed = "stays");
    LIMN_FIELD(velocity, "initial velocity of its center of mass", "m/s");
    LIMN_FIELD(spin, "initial angular velocity about world axes", "rad/s");
}

/// What the buoyancy system keeps for each Floating.
struct FloatingState {
    Vec3 velocity = {0, 0, 0};
    Vec3 spin = {0, 0, 0};
    float submerged = 0.0f;
};

LIMN_FIELDS(FloatingState) {
    LIMN_FIELD(velocity, "velocity of its center of mass", "m/s");
    LIMN_FIELD(spin, "angular velocity about world axes", "rad/s");
    LIMN_FIELD(submerged, "submerged fraction of its volume", "", 0, 1);
}

}  // namespace limn
