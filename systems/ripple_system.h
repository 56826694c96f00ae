#pragma once

#include "ecs/commands.h"
#include "ecs/components/ripple.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Ages every ripple by a step. Expired components are removed from their entity; a ring with a
/// period restarts instead.
void update_ripples(
    Query<RippleRing> rings, Query<ScreenRipple> screens, Res<const FrameTime> time,
    Commands commands);

}  // namespace limn
