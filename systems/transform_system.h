#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// World matrices of entities: WorldTransform = the parent's WorldTransform * Transform, and those
// of the previous step. Entities attached to a joint use the joint's matrix instead of their
// Transform, which cannot represent shear.
//
// Roots are processed by chunk on all threads, children level by level. Change detection uses
// column versions: a chunk of roots is recomputed if its Transforms or its rows are newer than its
// WorldTransforms; a child, if that holds for its chunk or its parent was recomputed. When entities
// come to rest, PreviousWorldTransform catches up one step later, and then nothing is written.
//
// In its first step, and in the step of a jump of itself or of anything above it, an entity's
// previous matrix is its new one: no velocity. A Teleport is a jump at the beginning of the step,
// StepJumps has the others. A parent without WorldTransform counts as the world origin.

/// Adds WorldTransform and PreviousWorldTransform to every entity with a Transform that lacks them.
/// Before update_transforms, with a sync point in between, so that new entities are drawn in the
/// same step.
void add_world_transforms(
    Query<const Transform, Without<WorldTransform>> bare,
    Query<const Transform, Without<PreviousWorldTransform>> without_past, Commands commands);

/// The columns whose versions update_transforms uses for change detection.
using TransformVersions =
    Query<const Transform, const WorldTransform, const PreviousWorldTransform>;

/// Writes WorldTransform and PreviousWorldTransform, removes Teleport, lists the jumps.
void update_transforms(
    TransformVersions versions,
    Query<const Transform, WorldTransform, PreviousWorldTransform> bodies,
    Query<const WorldTransform> worlds, Query<const Transform, With<Teleport>> teleports,
    Query<const JointAttachment> attachments, Query<const Pose> poses, OptionalRes<StepJumps> jumps,
    HierarchyRef hierarchy, Commands commands);

}  // namespace limn
