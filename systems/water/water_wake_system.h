#pragma once

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "ecs/components/water_wake.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Wakes (water.wake): rings along the way of what moves through water. A ring of waves that run
// with speed c, from a source of speed v > c, stays within the wedge of half angle asin(c / v)
// behind it; at c = v / 3 that is Kelvin's, 19.47 degrees, as the length 2 pi (v / 3)^2 / g does in
// deep water.

/// Half angle of the wedge that all ships have in deep water (Kelvin 1887) [rad].
inline constexpr float kKelvinAngle = 0.33983691f;

/// Length of the waves of a wake at `speed` [m/s] whose wedge is Kelvin's [m].
[[nodiscard]] float kelvin_length(float speed);

/// Adds rings to the waters that emitters have moved through since the last step. After
/// age_wave_packets. Who stands, jumps or is away from water leaves none.
void emit_wakes(
    Query<WakeEmitter, const WorldTransform> emitters,
    Query<const Water, const WorldTransform, WaterWaves> waters, Res<const FrameTime> time);

}  // namespace limn
