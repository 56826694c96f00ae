#pragma once

#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// What makes an entity a character, and what follows it. The data they name - skeletons, clips,
// skins - lies in the Assets resource (skeleton.h, surface.h).

/// The character: the root joint of the skeleton stands where the entity does.
struct Skeleton {
    SkeletonId skeleton;
};

/// Beside a Skeleton: the clip that moves it. Without a clip it rests.
struct ClipPlayer {
    ClipId clip;
    float time = 0.0f;   ///< in the clip [s]; grows with each step
    float speed = 1.0f;  ///< 1: as recorded; negative: backward
    bool loop = true;    ///< otherwise it holds the last pose
};

/// Beside a Skeleton: where its joints are. Written by update_poses alone, before
/// update_transforms.
struct Pose {
    std::vector<Affine> joints;    ///< character_from_joint after the last step
    std::vector<Affine> previous;  ///< one step earlier; equal to `joints` in the step of the spawn
};

/// Beside a Skeleton, or alone: how far each morph target of the character's meshes is on. Clips
/// write it.
struct MorphWeights {
    std::vector<float> weights;
    std::vector<float> previous;  ///< one step earlier; as long as `weights` after the first step
};

/// One of several that play at once.
struct MorphAnimation {
    ClipId clip;          ///< its morph weights alone
    float time = 0.0f;    ///< in the clip [s]; grows with each step
    float speed = 1.0f;   ///< 1: as recorded; negative: backward
    float weight = 1.0f;  ///< of all it does
    bool loop = true;     ///< otherwise it holds the last shape
};

/// Beside MorphWeights: animations of different regions of a face, added up (char.morph-anim). The
/// targets that they name are theirs alone.
struct MorphPlayer {
    std::vector<MorphAnimation> animations;
};

enum class Skinning : std::uint8_t {
    Linear,          ///< blends matrices: any scale; twisted joints lose volume
    DualQuaternion,  ///< blends screw motions (Kavan 2007): twisted joints keep it; no scale
};

/// Beside a MeshInstance: its vertices follow a character. First morph targets are added, then
/// joints move them. Stands where the character stands: the child of it, or the same entity.
struct Deformed {
    Entity character;               ///< with Pose or MorphWeights or both; gone: as at rest
    SkinId skin;                    ///< none: morph targets alone
    std::uint32_t first_morph = 0;  ///< place of the mesh's target 0 in MorphWeights
    Skinning skinning = Skinning::Linear;
};

/// Follows a joint: its Transform is written by update_attachments, before update_transforms. A
/// child of the character.
struct JointAttachment {
    Entity character;
    std::uint16_t joint = 0;
};

/// A copy of a prefab has no past.
template <>
struct ComponentTraits<Pose> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

template <typename Visitor>
void visit_fields(Skeleton& skeleton, Visitor&& visit) {
    visit("skeleton", skeleton.skeleton, {.doc = "a skeleton of the level, by name"});
}

template <typename Visitor>
void visit_fields(ClipPlayer& player, Visitor&& visit) {
    visit("clip", player.clip, {.doc = "a clip of the level, by name"});
    visit("time", player.time, {.doc = "in the clip", .unit = "s", .min = 0});
    visit(
        "speed", player.speed,
        {.doc = "1 as recorded; negative: backward", .min = -100, .max = 100});
    visit("loop", player.loop, {.doc = "otherwise it holds the last pose"});
}

template <typename Visitor>
void visit_fields(Pose& pose, Visitor&& visit) {
    visit("joints", pose.joints, {.doc = "character_from_joint after the last step"});
    visit("previous", pose.previous, {.doc = "one step earlier"});
}

template <typename Visitor>
void visit_fields(MorphWeights& morph, Visitor&& visit) {
    visit("weights", morph.weights, {.doc = "how far each morph target is on"});
    visit("previous", morph.previous, {.doc = "one step earlier"});
}

template <typename Visitor>
void visit_fields(MorphAnimation& animation, Visitor&& visit) {
    visit("clip", animation.clip, {.doc = "a clip of the level, by name; its morph weights alone"});
    visit("time", animation.time, {.doc = "in the clip", .unit = "s", .min = 0});
    visit(
        "speed", animation.speed,
        {.doc = "1 as recorded; negative: backward", .min = -100, .max = 100});
    visit("weight", animation.weight, {.doc = "of all it does", .min = -10, .max = 10});
    visit("loop", animation.loop, {.doc = "otherwise it holds the last shape"});
}

template <typename Visitor>
void visit_fields(MorphPlayer& player, Visitor&& visit) {
    visit("animations", player.animations, {.doc = "that play at once and are added up"});
}

template <typename Visitor>
void visit_fields(Deformed& deformed, Visitor&& visit) {
    visit("character", deformed.character, {.doc = "whose pose and morph weights it follows"});
    visit("skin", deformed.skin, {.doc = "a skin of the level, by name; none: morphs alone"});
    visit("first_morph", deformed.first_morph, {.doc = "place of target 0 in the morph weights"});
    visit(
        "skinning", deformed.skinning,
        {.doc = "how joints are blended", .values = "linear dual_quaternion"});
}

template <typename Visitor>
void visit_fields(JointAttachment& attachment, Visitor&& visit) {
    visit("character", attachment.character, {.doc = "whose joint it follows"});
    visit("joint", attachment.joint, {.doc = "index of the joint"});
}

}  // namespace limn
