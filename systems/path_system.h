#pragma once

#include "ecs/components/path.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Advances every PathFollower by a step and writes its Transform. One whose path does not exist
/// stays where it is; one on an open path stops at its ends.
void update_path_followers(
    Query<PathFollower, Transform> followers, Res<const Assets> assets, Res<const FrameTime> time);

/// Writes the Transform without advancing: for the first frame.
void place_path_followers(Query<const PathFollower, Transform> followers, Res<const Assets> assets);

}  // namespace limn
