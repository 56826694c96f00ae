#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/system.h"
#include "systems/animation/clip_sampling.h"

namespace limn {

/// Where `player`, a ClipPlayer or a MorphAnimation, is in a clip of this length after `step` [s]:
/// begins anew at the end, or holds; always 0 .. duration, whatever its fields hold.
template <typename Player>
[[nodiscard]] float step_clip_time(const Player& player, float duration, float step) {
    return clip_time(duration, player.time + player.speed * step, player.loop);
}

/// Advances every ClipPlayer, and every animation of a MorphPlayer, by one step. One without a clip
/// keeps its time.
void advance_clips(
    Query<ClipPlayer> players, Query<MorphPlayer> morph_players, Res<const Assets> assets,
    Res<const FrameTime> time);

}  // namespace limn
