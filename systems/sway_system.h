#pragma once

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Moves every Sway to its position at the end of this step. A function of time only: it does not
/// drift, and time may jump.
void update_sways(Query<const Sway, Transform> swaying, Res<const FrameTime> time);

}  // namespace limn
