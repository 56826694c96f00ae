#pragma once

#include "ecs/components/move_intent.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "systems/animation/walk/walk_body.h"
#include "systems/animation/walk/walk_plan.h"

#include <optional>

namespace limn {

// Feet that step from print to print, below a root that moves as its MoveIntent wants, or as
// something else moves it. A step has a foot that flies, for three quarters of it, and then both
// feet on the ground. Prints are planned when a foot leaves the ground, and follow the plan until
// shortly before it lands. All paths have continuous velocities.
// Techniques: char.foot-flight, char.walk-cycle

/// One step of one character, of any length [s]. `intent`: 0 where it stands. `lift`: height of the
/// ground below its feet, for those whose FootPlant puts them there: prints are level then [m].
void step_walk(
    const Walk& walk, const MoveIntent& intent, const WalkBody& body, std::optional<float> lift,
    float step, WalkState& state, Transform& transform);

/// Stands with both feet below the root.
void place_walk(
    const Walk& walk, const WalkBody& body, const Transform& transform, WalkState& state);

/// Where feet and hips have to be, in the space of the character.
[[nodiscard]] WalkTargets
find_walk_targets(const WalkBody& body, const WalkState& state, const Transform& transform);

/// Size of a character relative to its skeleton, > 0.
[[nodiscard]] float uniform_scale(const Transform& transform);

}  // namespace limn
