#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/crowd.h"
#include "ecs/components/crowd_script.h"
#include "ecs/components/ik.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/walk/crowd_walk_clips.h"

namespace limn {

// What the people of a crowd do: they walk as fast as they are moved, else they stand, talk, sit or
// wave, and look at somebody who comes near. With a CrowdPose clips fade into each other.
// Techniques: char.crowd-script

/// Adds a state to every CrowdScript without one.
void add_crowd_scripts(Query<const CrowdScript, Without<CrowdScriptState>> bare, Commands commands);

/// Plays the walk of those that move and do not stand, so that feet on the ground do not slide, and
/// the activity of the others, whose clips it makes when first needed. After update_crowd. Those
/// without a CrowdScript only walk; those without a CrowdAgent are moved by something else.
void update_crowd_scripts(
    Query<
        const CrowdWalk, const Skeleton, ClipPlayer, Optional<const CrowdState>,
        Optional<const CrowdScript>, Optional<CrowdScriptState>>
        members,
    Res<Assets> assets, Res<CrowdWalkClips> walks);

/// Members look at whom they notice, and some wave; LookAt is added for as long as it takes.
void notice_characters(
    Query<const CrowdScript, CrowdScriptState, const Transform, Optional<LookAt>> members,
    Query<const Transform> transforms, Res<const RandomSeed> seed, Res<const FrameTime> time,
    Commands commands);

}  // namespace limn
