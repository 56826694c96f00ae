#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/system.h"
#include "systems/animation/clip_sampling.h"

namespace limn {

/// Clip time of `player`, a ClipPlayer or a MorphAnimation, after `step` [s]: wraps or holds at the
/// end; always within 0 .. duration, whatever the values of its fields.
template <typename Player>
[[nodiscard]] float step_clip_time(const Player& player, float duration, float step) {
    return clip_time(duration, player.time + player.speed * step, player.loop);
}

/// Advances every ClipPlayer, and every animation of a MorphPlayer, by one step. One without a clip
/// keeps its time; those of characters with PoseKeys are advanced by advance_pose_keys().
void advance_clips(
    Query<ClipPlayer, Without<PoseKeysState>> players, Query<MorphPlayer> morph_players,
    Res<const Assets> assets, Res<const FrameTime> time);

}  // namespace limn
