#pragma once

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Puts every Sway where its closed path is at the end of this step. A function of the time alone:
/// it does not drift, and the time may jump.
void update_sways(Query<const Sway, Transform> swaying, Res<const FrameTime> time);

}  // namespace limn
