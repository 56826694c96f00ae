#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

enum class ForceKind : std::uint8_t {
    Push,     ///< along the local +y axis
    Attract,  ///< toward the entity, equally strong everywhere
    Spring,   ///< toward the entity, in proportion to the distance
    Whirl,    ///< around the local +y axis
    Wind,     ///< toward a velocity along the local +y axis, as drag does
};

/// Moves the particles of all emitters, beside their own ParticleMotion (particle.forces).
struct ForceField {
    ForceKind kind = ForceKind::Push;
    float strength = 5;
    float speed = 5;
    float radius = 0;
    float frequency = 0;
    float phase = 0;
};

LIMN_FIELDS(ForceField) {
    LIMN_FIELD(
        kind,
        .doc = "push: along local +y; attract, spring: toward the entity; whirl: around local +y; "
               "wind: toward a velocity along local +y",
        .values = "push attract spring whirl wind");
    LIMN_FIELD(
        strength,
        "acceleration; of a spring for a meter, of wind for each m/s relative to it; negative: "
        "in the opposite direction",
        "m/s^2", -1e4, 1e4);
    LIMN_FIELD(speed, "of the wind", "m/s", -1000, 1000);
    LIMN_FIELD(
        radius, "distance at which it has fallen to 0, quadratically; 0: no falloff", "m", 0, 1e5);
    LIMN_FIELD(frequency, "of a sine that modulates it; 0: constant", "1/s", 0, 1000);
    LIMN_FIELD(phase, "of the sine", "rad", -1e4, 1e4);
}

}  // namespace limn
