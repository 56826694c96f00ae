#pragma once

#include "ecs/commands.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"

namespace limn {

// Where entities are in the world: WorldTransform = the parent's WorldTransform * Transform, and
// where they were one step earlier.
//
// Roots are done chunk by chunk on all threads, children depth by depth. Only what changed is
// touched, by the versions of the columns: a chunk of roots is recomputed when its Transforms or
// its rows are newer than its WorldTransforms; a child, when that holds for its chunk or its parent
// was recomputed. Where things came to rest, PreviousWorldTransform catches up one step later, and
// from then on nothing is written.
//
// In its first step, and in the step of a Teleport of itself or of anything above it, an entity's
// previous matrix is its new one: no velocity. A parent without WorldTransform counts as the
// world's origin.

/// Gives a WorldTransform and a PreviousWorldTransform to every entity with a Transform that lacks
/// them. Before update_transforms, with a sync point between, so that what was spawned is drawn in
/// the same step.
void add_world_transforms(
    Query<const Transform, Without<WorldTransform>> bare,
    Query<const Transform, Without<PreviousWorldTransform>> without_past, Commands commands);

/// What update_transforms looks at to find out what changed.
using TransformVersions =
    Query<const Transform, const WorldTransform, const PreviousWorldTransform>;

/// Writes WorldTransform and PreviousWorldTransform, removes Teleport.
void update_transforms(
    TransformVersions versions,
    Query<const Transform, WorldTransform, PreviousWorldTransform> bodies,
    Query<const WorldTransform> worlds, Query<const Transform, With<Teleport>> teleports,
    HierarchyRef hierarchy, Commands commands);

}  // namespace limn
