#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/graph/motion_plan.h"
#include "systems/animation/graph/motion_pose.h"
#include "systems/animation/graph/root_motion.h"

#include <string_view>

namespace limn {

// Motion graphs: events and parameters select states, time advances them (char.motion-select).
// update_poses() evaluates the pose.

/// The event that a clip which does not loop sends at its end.
inline constexpr std::string_view kEndEvent = "end";

/// Adds a MotionGraphState, in the initial state, to every MotionGraph without one.
void add_motion_states(
    Query<const MotionGraph, With<Skeleton>, Without<MotionGraphState>> graphs,
    Res<const MotionGraphs> data, Commands commands);

/// Makes plans of graphs that are used for the first time.
void prepare_motion_plans(
    Query<const MotionGraph, const Skeleton> graphs, Res<const MotionGraphs> data,
    Res<const Assets> assets, Res<MotionPlans> plans);

/// Steps all graphs: takes their events, advances their clips, moves entities with root motion.
void update_motion_graphs(
    Query<
        const Skeleton, MotionGraph, MotionGraphState, Optional<const MotionStyle>,
        Optional<const MoveIntent>, Transform>
        characters,
    Res<const MotionGraphs> data, Res<const Assets> assets, Res<const MotionPlans> plans,
    Res<const FrameTime> time);

/// Advances one graph by `seconds`. Each event of `events` causes one transition: of those of the
/// current state, or else of any state, the first that fits. Events without one are dropped, and
/// all wait while a transition is not interruptible. Then at most one transition without an event,
/// and those of clips that end. Returns how the clips move the character.
GroundMove step_motion_graph(
    const MotionContext& context, std::vector<std::string>& events, float seconds,
    MotionGraphState& state);

/// Index of the transition for `event` ("": those without one); kNoGraphState: none.
[[nodiscard]] std::uint32_t
find_transition(const MotionContext& context, std::uint32_t state, std::string_view event);

/// Sets `speed` and `turn` so that the character, which heads along z of `rotation`, moves as
/// intended: it slows down while it turns.
void follow_intent(
    const MoveIntent& intent, const Quat& rotation, float seconds, MotionGraph& graph);

}  // namespace limn
