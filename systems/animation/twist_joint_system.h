#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/twist_joints.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"

namespace limn {

// Which joints the TwistJoints of characters are; update_poses turns them (twist_pose.h).

void add_twist_links(
    Query<const TwistJoints, With<Skeleton>, Without<TwistLinks>> bare, Commands commands);

/// Finds what changed. Before update_poses.
void update_twist_links(
    Query<const Skeleton, const TwistJoints, TwistLinks> characters, Res<const Assets> assets);

}  // namespace limn
