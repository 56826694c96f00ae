#pragma once

#include "ecs/components/motion_graph.h"
#include "systems/animation/graph/motion_pose.h"

namespace limn {

/// Forgets the transition that is not over, and frees its lists: most characters are in none.
void end_transition(MotionGraphState& state);

/// Ends the transition that is not over and makes the offsets, with their rates, of the pose that
/// `before` displays from that of `next` in `now`: what an inertialized transition begins with.
/// The contexts have the same skeleton; they differ if the graph was edited.
void capture_offsets(
    const MotionContext& before, const MotionContext& now, const GraphPlayback& next,
    MotionGraphState& state);

}  // namespace limn
