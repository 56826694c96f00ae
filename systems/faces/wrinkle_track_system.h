#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Weights of wrinkle maps over time: from keys of their own, or as channels of the clips that move
// the face. A channel is a shape (morph target) of the skin whose name is in kWrinkleChannels. It
// needs no vertices: a shape key without changes, which modeling programs key, blend and export
// with all others. So wrinkles are sampled at the time of the pose, blend and change speed with it.

/// Weights at `time` [s], clamped to the first and last key, presets resolved; zero without keys.
[[nodiscard]] WrinkleWeights wrinkle_weights_at(const WrinkleTrack& track, double time);

void update_wrinkle_tracks(
    Query<const WrinkleTrack, WrinkleWeights> tracks, Res<const FrameTime> time);

/// Copies channels to the WrinkleWeights of their skin, whose other regions are left alone. After
/// poses.
void update_wrinkle_channels(
    Query<const MeshInstance, const Deformed, WrinkleWeights> faces,
    Query<const MorphWeights> morphs, Res<const Assets> assets);

}  // namespace limn
