#pragma once

#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/step_jumps.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Characters, and entities that follow them. Skeletons, clips and skins are stored in the Assets
// resource (skeleton.h, surface.h).

/// Makes the entity a character; the skeleton's root joint is placed at the entity.
struct Skeleton {
    SkeletonId skeleton;
};

LIMN_FIELDS(Skeleton) {
    LIMN_FIELD(skeleton, "a skeleton of the level, by name");
}

/// With a Skeleton: the clip that animates it. Without a clip it is in its rest pose.
struct ClipPlayer {
    ClipId clip;
    float time = 0.0f;  ///< in the clip [s]; advances each step
    float speed = 1.0f;
    bool loop = true;
};

LIMN_FIELDS(ClipPlayer) {
    LIMN_FIELD(clip, "a clip of the level, by name");
    LIMN_FIELD(time, "time in the clip", "s", 0);
    LIMN_FIELD(speed, "playback rate; negative: backward", "", -100, 100);
    LIMN_FIELD(loop, "loops; otherwise holds the last pose");
}

/// Tag: the pose or the morph weights were changed discontinuously, so the next step yields no
/// velocity of them. Removed by update_poses.
struct PoseCut {};

template <>
struct ComponentTraits<PoseCut> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

/// With a Skeleton: its joint matrices. Only update_poses writes it, before update_transforms.
struct Pose {
    std::vector<Affine> joints;
    std::vector<Affine> previous;  ///< of the previous step; equal to `joints` in the first, and
                                   ///< that of a joint which jumped to the joint's
    std::vector<ValueJump<Affine>> jumps = {};  ///< of the last step, ascending; never saved
};

LIMN_FIELDS(Pose) {
    LIMN_FIELD(joints, "character_from_joint matrices after the last step");
    LIMN_FIELD(previous, "those of the previous step");
}

/// With a Skeleton, or alone: weights of the morph targets of the character's meshes, written by
/// clips.
struct MorphWeights {
    std::vector<float> weights;
    std::vector<float> previous;  ///< of the previous step; as long as `weights` after the first
    std::vector<ValueJump<float>> jumps = {};  ///< of the last step, ascending; never saved
};

LIMN_FIELDS(MorphWeights) {
    LIMN_FIELD(weights, "weight of each morph target");
    LIMN_FIELD(previous, "those of the previous step");
}

/// One of several simultaneous morph animations.
struct MorphAnimation {
    ClipId clip;
    float time = 0.0f;  ///< in the clip [s]; advances each step
    float speed = 1.0f;
    float weight = 1.0f;
    bool loop = true;
};

LIMN_FIELDS(MorphAnimation) {
    LIMN_FIELD(clip, "a clip of the level, by name; only its morph weights are used");
    LIMN_FIELD(time, "time in the clip", "s", 0);
    LIMN_FIELD(speed, "playback rate; negative: backward", "", -100, 100);
    LIMN_FIELD(weight, "blend weight of the animation", "", -10, 10);
    LIMN_FIELD(loop, "loops; otherwise holds the last shape");
}

/// With MorphWeights: additive animations of different regions of a face (char.morph-anim). Targets
/// that they animate are controlled by nothing else.
struct MorphPlayer {
    std::vector<MorphAnimation> animations;
};

LIMN_FIELDS(MorphPlayer) {
    LIMN_FIELD(animations, "simultaneous additive animations");
}

enum class Skinning : std::uint8_t {
    Linear,          ///< linear blend skinning: any scale; twisted joints lose volume
    DualQuaternion,  ///< dual quaternions (Kavan 2007): twisted joints keep volume; no scale
};

/// With a MeshInstance: its vertices are deformed by a character, by morph targets first, then by
/// joints. The entity must coincide with the character: a child of it, or the same entity.
struct Deformed {
    Entity character;  ///< with Pose, MorphWeights or both; if destroyed: rest pose
    SkinId skin;
    std::uint32_t first_morph = 0;
    Skinning skinning = Skinning::Linear;
};

LIMN_FIELDS(Deformed) {
    LIMN_FIELD(character, "entity whose pose and morph weights deform the mesh");
    LIMN_FIELD(skin, "a skin of the level, by name; none: morph targets only");
    LIMN_FIELD(first_morph, "index of the mesh's target 0 in the morph weights");
    LIMN_FIELD(skinning, .doc = "skinning method", .values = "linear dual_quaternion");
}

/// Attaches a child of the character to a joint: update_attachments writes its Transform, and
/// update_transforms its WorldTransform, from the joint's matrix.
struct JointAttachment {
    Entity character;
    std::uint16_t joint = 0;
};

LIMN_FIELDS(JointAttachment) {
    LIMN_FIELD(character, "entity whose joint it follows");
    LIMN_FIELD(joint, "index of the joint");
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<Pose> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
