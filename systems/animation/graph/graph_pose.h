#pragma once

#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/query.h"
#include "systems/animation/graph/motion_plan.h"

#include <span>

namespace limn {

/// Pose and morph weights of a character with a motion graph; false if it has none that is planned.
/// Weights that no clip animates are unchanged. Sets `is_cut` if its pose changed without a blend.
bool sample_motion_graph(
    const Query<const MotionGraph, const MotionGraphState, Optional<const MotionStyle>>& graphs,
    const MotionGraphs* data, const MotionPlans* plans, const Assets& assets, Entity entity,
    SkeletonId skeleton, LocalPose& pose, std::span<float> weights, bool& is_cut);

}  // namespace limn
