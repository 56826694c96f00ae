#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/system.h"
#include "systems/animation/clip_sampling.h"

namespace limn {

/// Advances every ClipPlayer, and every animation of a MorphPlayer, by one step. One without a clip
/// keeps its time; those of characters with PoseKeys are advanced by advance_pose_keys().
void advance_clips(
    Query<ClipPlayer, Without<PoseKeysState>> players, Query<MorphPlayer> morph_players,
    Res<const Assets> assets, Res<const FrameTime> time);

}  // namespace limn
