#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/system.h"

namespace limn {

// Where the joints of characters are, from their clips; and what hangs on the joints.
//
// `previous` of a Pose and of MorphWeights is what they were one step earlier. In the first step of
// a character, and in the step of a Teleport of itself or of anything above it, it is what they are
// now: no velocity. A clip that does not fit its skeleton counts as none: the character rests.

/// Gives a Pose to every Skeleton that lacks one, and then MorphWeights of 0 to those whose meshes
/// have morph targets but that have no weights. Before update_poses, with a sync point between.
void add_poses(
    Query<const Skeleton, Without<Pose>> bare, Query<const Deformed, const MeshInstance> meshes,
    Query<const MorphWeights> weights, Res<const Assets> assets, Commands commands);

/// Samples the clips: writes Pose and MorphWeights. Allocates only when a character is new.
void update_poses(
    Query<
        const Skeleton, Optional<const ClipPlayer>, Optional<const MorphPlayer>,
        Optional<MorphWeights>, Pose>
        characters,
    Query<
        MorphWeights, Optional<const ClipPlayer>, Optional<const MorphPlayer>,
        AnyOf<ClipPlayer, MorphPlayer>, Without<Skeleton>>
        faces,
    Query<const Transform, With<Teleport>> teleports, Query<const Parent> parents,
    Res<const Assets> assets);

/// Writes the Transform of what is attached to a joint. Where the character has no such joint, it
/// stays where it is.
void update_attachments(Query<const JointAttachment, Transform> attached, Query<const Pose> poses);

/// Gives the targets that the animations name the sum of what these make of them now.
void add_morph_animations(
    const MorphPlayer& player, const std::vector<ClipData>& clips, std::span<float> weights);

/// The joints and weights of a skeleton in `clip` at `time` [s]; at rest without a clip or where it
/// names joints or weights that are not there. `scratch` keeps its memory from call to call; there
/// is a matrix for each joint; weights that the clip does not move stay.
void evaluate_pose(
    const SkeletonData& skeleton, const ClipData* clip, float time, LocalPose& scratch,
    std::span<Affine> joints, std::span<float> weights);

}  // namespace limn
