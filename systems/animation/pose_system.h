#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/crowd_pose.h"
#include "ecs/components/mesh_levels.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/crowd_library.h"
#include "systems/animation/pose_modifiers.h"

namespace limn {

// Poses of characters from their clips, and entities attached to joints.
//
// `previous` of Pose and MorphWeights holds the values of the previous step. In a character's first
// step, and in the step of a PoseCut or of a Teleport of it or of an ancestor, it holds the current
// ones: no velocity. The same holds for joints and weights that jump within a clip. A clip that
// does not fit the skeleton is ignored: the character keeps its rest pose.

/// Adds a Pose to every Skeleton that lacks one, and MorphWeights of 0 to those among them that
/// lack weights although their meshes, surfaces that move meshes, or levels of detail of those with
/// a MorphPlayer have morph targets. Before update_poses, with a sync point in between.
void add_poses(
    Query<const Skeleton, Without<Pose>> bare, Query<const Deformed, const MeshInstance> meshes,
    Query<const Deformed, const ControlSurface> surfaces,
    Query<const Deformed, const MeshLevels, With<MorphPlayer>> levels,
    Query<const MorphWeights> weights, Res<const Assets> assets, Commands commands);

/// Samples the clips, applies the modifiers: writes Pose and MorphWeights. Allocates only for new
/// characters. Those with a CrowdPose are posed together unless they have modifiers, and only when
/// they are due (crowd_library.h).
void update_poses(
    Query<
        const Skeleton, Optional<const ClipPlayer>, Optional<const MorphPlayer>,
        Optional<const CrowdPose>, Optional<const CrowdPoseState>, Optional<MorphWeights>, Pose>
        characters,
    Query<
        MorphWeights, Optional<const ClipPlayer>, Optional<const MorphPlayer>,
        AnyOf<ClipPlayer, MorphPlayer>, Without<Skeleton>>
        faces,
    Query<const Transform, With<Teleport>> teleports, Query<const Parent> parents,
    Query<const PoseCut> pose_cuts, PoseModifiers modifiers, Res<const Assets> assets,
    OptionalRes<const FrameTime> time, OptionalRes<const CrowdLibrary> crowds, Commands commands);

/// Writes the Transform of attached entities, without shear, unless the character has no such
/// joint. They jump where their joint does.
void update_attachments(
    Query<const JointAttachment, Transform> attached, Query<const Pose> poses,
    OptionalRes<StepJumps> jumps);

/// Sets the morph targets that the animations control to the sum of their current weights.
void add_morph_animations(
    const MorphPlayer& player, const std::vector<ClipData>& clips, std::span<float> weights);

/// Joint matrices and morph weights of a skeleton in `clip` at `time` [s]; the rest pose without a
/// clip, or if the clip refers to missing joints or weights. `scratch` is reused between calls;
/// `joints` has one matrix per joint; weights that the clip does not animate are unchanged.
void evaluate_pose(
    const SkeletonData& skeleton, const ClipData* clip, float time, LocalPose& scratch,
    std::span<Affine> joints, std::span<float> weights);

}  // namespace limn
