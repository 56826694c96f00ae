#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/ik.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"

namespace limn {

// Where the goals of inverse kinematics are, in the spaces of the characters, at the time of this
// step: so early that no world transform is known yet. What hangs on a joint of another character
// is taken from the last step.

/// Adds IkGoals, Gaze and ReachState to characters that need them.
void add_ik_states(
    Query<const IkRig, With<Skeleton>, Without<IkGoals>> rigs,
    Query<const LookAt, With<Skeleton>, Without<Gaze>> looks,
    Query<const ReachGoal, With<Skeleton>, Without<ReachState>> reaches, Commands commands);

/// After everything that moves goals by time or input; before update_poses.
void update_ik_goals(
    Query<const Skeleton, const IkRig, IkGoals> rigs,
    Query<const Skeleton, const LookAt, Optional<const Pose>, Gaze> looks,
    Query<const Skeleton, const ReachGoal, ReachState> reaches, Query<const Transform> transforms,
    Query<const Parent> parents, Res<const Assets> assets, OptionalRes<const FrameTime> time);

}  // namespace limn
