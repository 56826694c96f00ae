#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/system.h"

namespace limn {

/// Where `player` is in a clip of this length after `step` [s]: begins anew at the end, or holds;
/// always 0 .. duration, whatever its fields hold.
[[nodiscard]] float step_clip_time(const ClipPlayer& player, float duration, float step);

/// Advances every ClipPlayer by one step. One without a clip keeps its time.
void advance_clips(Query<ClipPlayer> players, Res<const Assets> assets, Res<const FrameTime> time);

}  // namespace limn
