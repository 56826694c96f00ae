#pragma once

#include "ecs/components/skeleton.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Which bones of a skeleton are rigid capsules, how heavy, and how far their joints turn. Of a
// person (humanoid.h) these are hips, back, head and limbs; collar bones, fingers and toes go with
// them. Of others all bones that are not very short. Bones without length go with their parents.

enum class RagdollJointKind : std::uint8_t {
    Hinge,  ///< turns about one axis
    Cone,   ///< swings within an elliptic cone, and twists
};

/// How far a bone turns relative to its parent. Vectors are in the bone's space, in which the
/// joint's rotation is the identity at rest.
struct RagdollLimit {
    RagdollJointKind kind = RagdollJointKind::Cone;
    Vec3 axis = {1, 0, 0};    ///< of the hinge; of a cone: the first axis of its ellipse, unit
    Vec3 bone = {0, 1, 0};    ///< direction that swings, and about which it twists, unit
    Vec3 center = {0, 1, 0};  ///< middle of the cone, unit
    float min = -0.8f;        ///< of the hinge angle or the twist [rad]; min <= max
    float max = 0.8f;
    float swing = 0.8f;  ///< half angle of the cone for swings about `axis` [rad], > 0
    float sway = 0.8f;   ///< likewise for swings across it
};

/// A capsule, in the space of its joint at scale 1.
struct RagdollBone {
    std::uint16_t joint = 0;
    std::int32_t parent = -1;  ///< an earlier bone; -1: the first
    Vec3 from = {0, 0, 0};     ///< ends of the segment [m]
    Vec3 to = {0, 0, 0};
    float radius = 0.05f;
    float share = 0;           ///< of the mass
    Vec3 anchor = {0, 0, 0};   ///< the joint at rest in the space of the parent's joint [m]
    Quat rest = {1, 0, 0, 0};  ///< of the joint at rest, relative to the parent's, or to
                               ///< the character
    RagdollLimit limit{};
};

/// Bones with parents first; empty for a skeleton without length.
struct RagdollRig {
    std::vector<RagdollBone> bones{};
    std::vector<std::uint64_t> apart{};  ///< bit j of [i]: bones i and j may collide; i, j < 64
};

inline constexpr std::size_t kMaxRagdollBones = 64;

[[nodiscard]] RagdollRig make_ragdoll_rig(const SkeletonData& skeleton);

/// Volume of a capsule [m^3], and its moments of inertia for a mass of 1 kg about its center [m^2].
struct CapsuleMass {
    double volume = 0;
    double along = 0;   ///< about the segment
    double across = 0;  ///< about a line across it
};
[[nodiscard]] CapsuleMass find_capsule_mass(double length, double radius);

}  // namespace limn
