#pragma once

#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Rotates every Spin by speed * step about its local axis: rotation = rotation * turn. Does
/// nothing in a step of length 0.
void update_spins(Query<const Spin, Transform> spinning, Res<const FrameTime> time);

}  // namespace limn
