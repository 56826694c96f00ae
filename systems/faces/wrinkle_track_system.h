#pragma once

#include "ecs/components/time.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Weights at `time` [s], clamped to the first and last key; zero without keys.
[[nodiscard]] WrinkleWeights wrinkle_weights_at(const WrinkleTrack& track, double time);

void update_wrinkle_tracks(
    Query<const WrinkleTrack, WrinkleWeights> tracks, Res<const FrameTime> time);

}  // namespace limn
