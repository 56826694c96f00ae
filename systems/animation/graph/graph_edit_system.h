#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/animation/graph/motion_plan.h"
#include "systems/animation/graph/motion_pose.h"

#include <cstdint>

namespace limn {

// Edits of motion graphs while characters play them (char.motion-select).

/// Replaces the graphs that MotionGraphs::edits lists, makes their plans anew and takes their
/// characters over (adopt_graph), and those whose MotionGraph names another graph than they play.
/// Edits of graphs that do not exist are ignored.
void apply_graph_edits(
    Query<
        const Skeleton, const MotionGraph, MotionGraphState, Optional<const MotionStyle>,
        const Transform>
        characters,
    Res<MotionGraphs> data, Res<const Assets> assets, Res<MotionPlans> plans);

/// Continues a character of the graph `before` in the edited graph `now`: in its state, found by
/// name, at its phase, or else in the initial one. If the state or the transition that is not over
/// differ, the displayed pose is inertialized over the transition `blend` of `now`. Layers are
/// found by name; new ones fade in, and removed ones disappear at once.
void adopt_graph(
    const MotionContext& before, const MotionContext& now, std::uint32_t blend,
    MotionGraphState& state);

}  // namespace limn
