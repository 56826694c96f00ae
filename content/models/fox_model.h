#pragma once

#include "content/make/models/creature.h"
#include "content/make/models/creature_gait.h"
#include "content/make/models/implicit_model.h"

namespace limn::fox {

// The fox as data: joints, flesh, colors and gaits. All for a height of 0.45 m [m]; what is on both
// sides is listed once, for the left (+x).

using enum CreatureJoint;

inline constexpr float kHeight = 0.45f;

struct JointInfo {
    const char* name;
    std::int32_t parent;
    Vec3 position;  ///< [m]
};

inline constexpr JointInfo kJoints[kCreatureJoints] = {
    {"hips", -1, {0, 0.425f, -0.2f}},
    {"spine", 0, {0, 0.435f, -0.05f}},
    {"chest", 1, {0, 0.43f, 0.1f}},
    {"neck", 2, {0, 0.47f, 0.2f}},
    {"head", 3, {0, 0.605f, 0.285f}},
    {"jaw", 4, {0, 0.592f, 0.33f}},
    {"tail", 0, {0, 0.425f, -0.285f}},
    {"tail tip", 6, {0, 0.36f, -0.46f}},
    {"left shoulder", 2, {0.06f, 0.385f, 0.155f}},
    {"left elbow", 8, {0.066f, 0.255f, 0.085f}},
    {"left wrist", 9, {0.066f, 0.125f, 0.125f}},
    {"left paw", 10, {0.066f, 0.034f, 0.115f}},
    {"right shoulder", 2, {-0.06f, 0.385f, 0.155f}},
    {"right elbow", 12, {-0.066f, 0.255f, 0.085f}},
    {"right wrist", 13, {-0.066f, 0.125f, 0.125f}},
    {"right paw", 14, {-0.066f, 0.034f, 0.115f}},
    {"left thigh", 0, {0.058f, 0.385f, -0.19f}},
    {"left knee", 16, {0.072f, 0.25f, -0.115f}},
    {"left hock", 17, {0.068f, 0.145f, -0.24f}},
    {"left foot", 18, {0.068f, 0.034f, -0.215f}},
    {"right thigh", 0, {-0.058f, 0.385f, -0.19f}},
    {"right knee", 20, {-0.072f, 0.25f, -0.115f}},
    {"right hock", 21, {-0.068f, 0.145f, -0.24f}},
    {"right foot", 22, {-0.068f, 0.034f, -0.215f}},
};

constexpr ModelPart limb(
    CreatureJoint joint, const Vec3& a, const Vec3& b, float radius_a, float radius_b, float blend,
    const Vec3& squash = {1, 1, 1}) {
    return {
        .shape = PartShape::Squashed,
        .blend = blend,
        .a = a,
        .b = b,
        .radius_a = radius_a,
        .radius_b = radius_b,
        .squash = squash,
        .joint = static_cast<std::uint16_t>(joint)};
}

constexpr ModelPart cut(ModelPart part) {
    part.use = PartUse::Cut;
    return part;
}

inline constexpr ModelPart kParts[] = {
    // the trunk
    limb(Hips, {0, 0.4f, -0.2f}, {0, 0.402f, -0.1f}, 0.08f, 0.074f, 0.02f),
    limb(Spine, {0, 0.402f, -0.11f}, {0, 0.398f, 0.03f}, 0.072f, 0.084f, 0.02f),
    limb(Chest, {0, 0.385f, 0.05f}, {0, 0.395f, 0.135f}, 0.093f, 0.082f, 0.03f, {0.86f, 1.08f, 1}),
    limb(Chest, {0, 0.43f, 0.11f}, {0, 0.455f, 0.17f}, 0.07f, 0.066f, 0.04f),
    limb(Neck, {0, 0.455f, 0.17f}, {0, 0.575f, 0.258f}, 0.07f, 0.05f, 0.04f),
    // the bib
    limb(Neck, {0, 0.42f, 0.195f}, {0, 0.53f, 0.262f}, 0.05f, 0.038f, 0.04f),
    // the head
    limb(Head, {0, 0.638f, 0.3f}, {0, 0.634f, 0.322f}, 0.078f, 0.07f, 0.035f, {0.98f, 0.87f, 1}),
    limb(Head, {0.036f, 0.605f, 0.318f}, {0.064f, 0.592f, 0.308f}, 0.043f, 0.022f, 0.035f),
    limb(Head, {0, 0.619f, 0.352f}, {0, 0.6f, 0.466f}, 0.042f, 0.0185f, 0.034f, {1, 0.95f, 1}),
    limb(
        Head, {0, 0.6075f, 0.476f}, {0, 0.6075f, 0.478f}, 0.0145f, 0.014f, 0.006f,
        {1.1f, 0.9f, 0.9f}),
    limb(Jaw, {0, 0.588f, 0.352f}, {0, 0.581f, 0.437f}, 0.024f, 0.0125f, 0.008f, {1.15f, 0.8f, 1}),
    // ears: cups that open forward and outward
    limb(
        Head, {0.05f, 0.676f, 0.288f}, {0.088f, 0.8f, 0.274f}, 0.043f, 0.011f, 0.018f,
        {1, 1, 0.62f}),
    // the tail
    limb(Tail, {0, 0.415f, -0.25f}, {0, 0.39f, -0.37f}, 0.032f, 0.043f, 0.03f),
    limb(Tail, {0, 0.39f, -0.37f}, {0, 0.355f, -0.47f}, 0.043f, 0.056f, 0.004f),
    limb(TailTip, {0, 0.355f, -0.47f}, {0, 0.322f, -0.57f}, 0.056f, 0.05f, 0.004f),
    limb(TailTip, {0, 0.322f, -0.57f}, {0, 0.29f, -0.71f}, 0.05f, 0.01f, 0.004f),
    // front legs
    limb(LeftShoulder, {0.05f, 0.4f, 0.125f}, {0.066f, 0.27f, 0.092f}, 0.055f, 0.031f, 0.04f),
    limb(LeftElbow, {0.066f, 0.265f, 0.088f}, {0.066f, 0.13f, 0.124f}, 0.0295f, 0.0185f, 0.02f),
    limb(LeftWrist, {0.066f, 0.128f, 0.125f}, {0.066f, 0.036f, 0.117f}, 0.019f, 0.017f, 0.008f),
    limb(
        LeftPaw, {0.066f, 0.0225f, 0.12f}, {0.067f, 0.019f, 0.158f}, 0.0225f, 0.019f, 0.015f,
        {1.15f, 1, 1}),
    // hind legs
    limb(
        LeftThigh, {0.044f, 0.385f, -0.175f}, {0.07f, 0.27f, -0.13f}, 0.07f, 0.043f, 0.04f,
        {0.85f, 1, 1}),
    limb(LeftKnee, {0.071f, 0.262f, -0.126f}, {0.068f, 0.155f, -0.232f}, 0.037f, 0.0195f, 0.02f),
    limb(LeftHock, {0.068f, 0.148f, -0.238f}, {0.068f, 0.036f, -0.215f}, 0.02f, 0.017f, 0.008f),
    limb(
        LeftFoot, {0.068f, 0.0225f, -0.21f}, {0.069f, 0.019f, -0.168f}, 0.0225f, 0.019f, 0.015f,
        {1.15f, 1, 1}),
    // the insides of the ears
    cut(limb(
        Head, {0.058f, 0.7f, 0.314f}, {0.085f, 0.77f, 0.297f}, 0.028f, 0.008f, 0.012f,
        {1, 1, 0.55f})),
};

/// From the corner of the eye down the muzzle, in another color.
inline constexpr ModelPart kTear =
    limb(Head, {0.043f, 0.641f, 0.372f}, {0.021f, 0.616f, 0.437f}, 0.003f, 0.003f, 0);

// ---- colors, linear -----------------------------------------------------------------------------

inline constexpr Vec3 kCoat = {0.56f, 0.175f, 0.036f};
inline constexpr Vec3 kBack = {0.36f, 0.095f, 0.022f};
inline constexpr Vec3 kCream = {0.8f, 0.7f, 0.56f};
inline constexpr Vec3 kSock = {0.05f, 0.031f, 0.026f};
inline constexpr Vec3 kNose = {0.012f, 0.01f, 0.01f};
inline constexpr Vec3 kEarLining = {0.47f, 0.3f, 0.215f};
inline constexpr Vec3 kPupil = {0.004f, 0.004f, 0.004f};
inline constexpr Vec3 kIris = {0.62f, 0.3f, 0.05f};
inline constexpr Vec3 kIrisEdge = {0.3f, 0.1f, 0.015f};
inline constexpr Vec3 kLidRim = {0.03f, 0.02f, 0.016f};

// ---- texture charts: the bones that each is unwrapped around ------------------------------------

inline constexpr Vec3 kTrunkBones[] = {{0, 0.604f, 0.48f}, {0, 0.62f, 0.32f},  {0, 0.57f, 0.26f},
                                       {0, 0.46f, 0.18f},  {0, 0.405f, 0.1f},  {0, 0.405f, -0.2f},
                                       {0, 0.4f, -0.34f},  {0, 0.36f, -0.46f}, {0, 0.28f, -0.72f}};
inline constexpr Vec3 kFrontBones[] = {
    {0.05f, 0.42f, 0.13f},
    {0.066f, 0.26f, 0.088f},
    {0.066f, 0.13f, 0.124f},
    {0.066f, 0.022f, 0.116f},
    {0.067f, 0.018f, 0.175f}};
inline constexpr Vec3 kHindBones[] = {
    {0.046f, 0.41f, -0.18f},
    {0.071f, 0.258f, -0.122f},
    {0.068f, 0.15f, -0.236f},
    {0.068f, 0.022f, -0.213f},
    {0.069f, 0.018f, -0.15f}};

// ---- gaits --------------------------------------------------------------------------------------

struct LegInfo {
    CreatureJoint joints[4];  ///< upper, middle, last, foot
    CreatureJoint parent;
    float bend;      ///< +1: the knee points forward, -1: the elbow backward
    float center;    ///< of its stance, along z [m]
    float set_down;  ///< angle of the last bone at touchdown [rad]
    float push_off;  ///< and at lift-off [rad]
    float fold;      ///< added in the air [rad]
};

inline constexpr LegInfo kLegInfos[kLegs] = {
    {{LeftShoulder, LeftElbow, LeftWrist, LeftPaw}, Chest, -1, 0.142f, 0.15f, -0.55f, -0.95f},
    {{RightShoulder, RightElbow, RightWrist, RightPaw}, Chest, -1, 0.142f, 0.15f, -0.55f, -0.95f},
    {{LeftThigh, LeftKnee, LeftHock, LeftFoot}, Hips, 1, -0.19f, 0.5f, -0.4f, -0.35f},
    {{RightThigh, RightKnee, RightHock, RightFoot}, Hips, 1, -0.19f, 0.5f, -0.4f, -0.35f},
};

inline constexpr int kGaitKeys = 48;  ///< of a cycle

/// Touchdown and lift-off are at keys; between keys a foot would be interpolated off the ground.
inline constexpr Gait kGaits[] = {
    {.name = "idle",
     .period = 5.0f,
     .stride = 0,
     .duty = 1,
     .touchdown = {0, 0, 0, 0},
     .lift = 0,
     .drop = 0.004f,
     .bob = 0.002f,
     .bobs = 2,
     .top = 0.25f,
     .flex = 0.01f,
     .crouch = 0,
     .tail = 0.35f,
     .breaths = 2},
    {.name = "walk",
     .period = 0.95f,
     .stride = 0.4f,
     .duty = 32.0f / kGaitKeys,
     .touchdown = {0.25f, 0.75f, 0, 0.5f},
     .lift = 0.05f,
     .drop = 0.014f,
     .bob = 0.005f,
     .bobs = 2,
     .top = 0.1f,
     .flex = 0.02f,
     .crouch = 0.12f,
     .tail = 0.16f,
     .breaths = 1},
    {.name = "trot",
     .period = 0.56f,
     .stride = 0.68f,
     .duty = 21.0f / kGaitKeys,
     .touchdown = {0.5f, 0, 0, 0.5f},
     .lift = 0.06f,
     .drop = 0.02f,
     .bob = 0.008f,
     .bobs = 2,
     .top = 0.48f,
     .flex = 0.03f,
     .crouch = 0.2f,
     .tail = 0.12f,
     .breaths = 1},
    {.name = "run",
     .period = 0.44f,
     .stride = 1.1f,
     .duty = 13.0f / kGaitKeys,
     .touchdown = {20.0f / kGaitKeys, 26.0f / kGaitKeys, 0, 6.0f / kGaitKeys},
     .lift = 0.1f,
     .drop = 0.042f,
     .bob = 0.02f,
     .bobs = 1,
     .top = 0.92f,
     .flex = 0.24f,
     .crouch = 0.42f,
     .tail = 0.1f,
     .breaths = 1},
};

}  // namespace limn::fox
