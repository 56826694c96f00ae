#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

// Techniques: water.wake

/// Leaves a wake where its entity moves through water that has WaterWaves: a ring of waves every
/// `spacing` of distance traveled.
struct WakeEmitter {
    float spacing = 1.0f;
    float amplitude = 0.04f;
    float length = 0;
    std::uint32_t waves = 2;
    float decay = 3.0f;  ///< time constant of a ring [s]; it ends after three of them
};

LIMN_FIELDS(WakeEmitter) {
    LIMN_FIELD(spacing, "distance between rings", "m", 0.01, 1000);
    LIMN_FIELD(amplitude, "initial amplitude of a ring", "m", 0, 10);
    LIMN_FIELD(length, "wavelength; 0: gives a Kelvin wake", "m", 0, 1000);
    LIMN_FIELD(waves, "waves per ring", "", 1, 100);
    LIMN_FIELD(decay, "time constant of a ring's decay", "s", 0.01, 1000);
}

/// What the wake system keeps for each WakeEmitter.
struct WakeState {
    bool started = false;
    Vec2 last_ring = {0, 0};
    Vec2 previous = {0, 0};
};

LIMN_FIELDS(WakeState) {
    LIMN_FIELD(started, "last_ring and previous are valid");
    LIMN_FIELD(last_ring, "where the last ring was emitted, world x and z", "m");
    LIMN_FIELD(previous, "position in the previous step, world x and z", "m");
}

}  // namespace limn
