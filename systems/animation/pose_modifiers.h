#pragma once

#include "ecs/components/foot_plant.h"
#include "ecs/components/ik.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/puppet.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/twist_joints.h"
#include "ecs/components/walk.h"
#include "ecs/param_group.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/animation/graph/motion_plan.h"
#include "systems/animation/puppet/puppet_body.h"
#include "systems/animation/walk/walk_body.h"

namespace limn {

/// What determines the poses of characters besides a clip, and changes them before their joint
/// matrices, as one
/// parameter of update_poses.
struct PoseModifiers {
    Query<const Walk, const WalkState, const WalkBody> walks;
    Query<const MotorPose, const MotorPoseState> motor_poses;
    Query<const FootPlant, const FootContacts> plants;
    Query<const IkRig, const IkGoals> rigs;
    Query<const LookAt, const Gaze> looks;
    Query<const ReachGoal, const ReachState> reaches;
    Query<const MotionGraph, const MotionGraphState, Optional<const MotionStyle>> graphs;
    OptionalRes<const MotionGraphs> graph_data;
    OptionalRes<const MotionPlans> plans;
    Query<const RagdollState> ragdolls;
    Query<const PoseKeysState> keys;
    Query<const TwistJoints, const TwistLinks> twists;
    Query<const MatchPose, const MotionMatchState> matches;
    Query<MatchHandover> handovers;
    Query<const PuppetState, const PuppetBody> puppets;
};

template <>
struct SystemParam<PoseModifiers>
    : ParamGroup<
          PoseModifiers, Query<const Walk, const WalkState, const WalkBody>,
          Query<const MotorPose, const MotorPoseState>, Query<const FootPlant, const FootContacts>,
          Query<const IkRig, const IkGoals>, Query<const LookAt, const Gaze>,
          Query<const ReachGoal, const ReachState>,
          Query<const MotionGraph, const MotionGraphState, Optional<const MotionStyle>>,
          OptionalRes<const MotionGraphs>, OptionalRes<const MotionPlans>,
          Query<const RagdollState>, Query<const PoseKeysState>,
          Query<const TwistJoints, const TwistLinks>,
          Query<const MatchPose, const MotionMatchState>, Query<MatchHandover>,
          Query<const PuppetState, const PuppetBody>> {};

}  // namespace limn
