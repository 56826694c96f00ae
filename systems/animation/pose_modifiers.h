#pragma once

#include "ecs/components/foot_plant.h"
#include "ecs/components/ik.h"
#include "ecs/param_group.h"
#include "ecs/query.h"

namespace limn {

/// What changes the poses of characters between their clips and their joint matrices, as one
/// parameter of update_poses.
struct PoseModifiers {
    Query<const FootPlant, const FootContacts> plants;
    Query<const IkRig, const IkGoals> rigs;
    Query<const LookAt, const Gaze> looks;
    Query<const ReachGoal, const ReachState> reaches;
};

template <>
struct SystemParam<PoseModifiers>
    : ParamGroup<
          PoseModifiers, Query<const FootPlant, const FootContacts>,
          Query<const IkRig, const IkGoals>, Query<const LookAt, const Gaze>,
          Query<const ReachGoal, const ReachState>> {};

}  // namespace limn
