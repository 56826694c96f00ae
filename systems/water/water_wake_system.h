#pragma once

#include "ecs/commands.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_wake.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Wakes (water.wake): rings of waves emitted along the track of a moving entity. Rings with wave
// speed c from a source of speed v > c stay within a wedge of half angle asin(c / v) behind it; at
// c = v / 3 that is the Kelvin wedge, 19.47 degrees, which in deep water needs the wavelength 2 pi
// (v / 3)^2 / g.

/// Half angle of the Kelvin wedge, the same for all ships in deep water (Kelvin 1887) [rad].
inline constexpr float kKelvinAngle = 0.33983691f;

/// Wavelength that gives a Kelvin wedge at `speed` [m/s], in [m].
[[nodiscard]] float kelvin_length(float speed);

/// Gives each WakeEmitter its state. Before emit_wakes, with a sync point in between.
void add_wake_states(Query<const WakeEmitter, Without<WakeState>> emitters, Commands commands);

/// Adds rings to the waters that emitters moved through since the previous step. After
/// age_wave_packets. Emitters at rest, teleporting or away from water add none.
void emit_wakes(
    Query<const WakeEmitter, WakeState, const WorldTransform> emitters,
    Query<const Water, const WorldTransform, WaterWaves> waters, Res<const FrameTime> time);

}  // namespace limn
