#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/crowd.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/characters/grounds.h"
#include "systems/crowd/flow_field.h"
#include "systems/crowd/step_crowd.h"

#include <cstdint>
#include <vector>

namespace limn {

// Walkers go to their goals: wanted velocities from goals, flow fields and intents, one step of all
// (step_crowd.h), then headings, heights on walkable ground and the speeds of their clips.

/// Resource: what update_crowd() computed and keeps; derived, never saved.
struct CrowdMemory {
    /// Ways to an exit in a space, as long as neither they nor the obstacles change.
    struct Ways {
        std::uint64_t inputs = 0;  ///< hash of all that the field depends on
        FlowGrid grid{};
        FlowField field{};
    };
    std::vector<Ways> ways{};
    WalkerScratch scratch{};
    std::vector<CrowdWalker> walkers{};
};

void add_crowd_states(Query<const CrowdAgent, Without<CrowdState>> bare, Commands commands);

using WalkerQuery = Query<
    const CrowdAgent, CrowdState, Transform, Optional<CrowdGoal>, Optional<const MoveIntent>,
    Optional<ClipPlayer>, Without<Parent>>;
/// Walkers whose numbers are not finite neither move nor are seen.
void update_crowd(
    WalkerQuery walkers, Query<const CrowdObstacle> obstacles, Query<const CrowdExit> exits,
    Query<const CrowdSpace> spaces, GroundQueries grounds, Res<const Assets> assets,
    Res<CrowdMemory> memory, Res<const RandomSeed> seed, Res<const FrameTime> time);

}  // namespace limn
