#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/walk.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/walk/crowd_walk_clips.h"

namespace limn {

// Members of a crowd share walks that were made once: S styles of m keys of n joints take
// S m (1 + 7 n) numbers, however many people there are. Equal phases look like marching, so members
// should have different ones. With a CrowdPose they are posed together, and less often far away.
// Techniques: char.crowd-script

/// Makes the clips of the styles that members need, and gives each member without a ClipPlayer one
/// that plays its style. Before advance_clips, with a sync point in between. A member without a
/// style, or whose style has no Walk, gets the default one.
void add_crowd_walks(
    Query<const CrowdWalk, const Skeleton, Without<ClipPlayer>> members, Query<const Walk> styles,
    Res<Assets> assets, Res<CrowdWalkClips> walks, Commands commands);

}  // namespace limn
