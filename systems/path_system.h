#pragma once

#include "ecs/components/path.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Moves every PathFollower on by a step and puts its Transform there. One whose path does not
/// exist stays where it is; one on an open path stops at its ends.
void update_path_followers(
    Query<PathFollower, Transform> followers, Res<const Assets> assets, Res<const FrameTime> time);

/// Puts it where it is, without moving it on: for the first picture.
void place_path_followers(Query<const PathFollower, Transform> followers, Res<const Assets> assets);

}  // namespace limn
