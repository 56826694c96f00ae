#pragma once

#include "ecs/components/skeleton.h"
#include "systems/animation/crowd_clip.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Poses of crowds, from clips to matrices, 16 characters at a time: sampled and blended with joints
// of one character in the lanes of vectors into a small buffer, transposed, then multiplied down
// the hierarchy with 16 characters in the lanes, and written once.
//
// Like those of pose_kernels.h, each kernel has a version for the machine's widest vectors and a
// plain C++ one, `_scalar`, with bit-identical results: exact square roots and divisions, no fused
// multiply-add. A character's matrices do not depend on its neighbors.
//
// Joints are sorted parents first, so that the first ones of a skeleton are a skeleton too: one of
// less detail if what matters most comes first. A rig of fewer joints than its clips have samples,
// blends and multiplies only those, with the bits that they have among all.

/// A skeleton prepared for that. A joint's matrix stays in a slot until its last child has read it:
/// a few slots stay in the cache, all matrices of 16 characters would not.
struct CrowdRig {
    static constexpr std::uint16_t kNoSlot = 0xffff;
    std::vector<std::int32_t> parents;
    std::vector<std::uint16_t> parent_slots;  ///< kNoSlot: the root
    std::vector<std::uint16_t> slots;         ///< kNoSlot: a joint without children
    std::size_t slot_count = 0;
    std::vector<Vec3> scales;          ///< at rest
    std::vector<std::uint8_t> scaled;  ///< joints whose scale is not 1

    [[nodiscard]] std::size_t joints() const { return parents.size(); }
};
inline constexpr std::size_t kAllJoints = ~std::size_t{0};
/// Of the first `max_joints` joints.
[[nodiscard]] CrowdRig
make_crowd_rig(const SkeletonData& skeleton, std::size_t max_joints = kAllJoints);

/// Local rotations and translations of one character: seven rows, x y z w of the rotations and x y
/// z of the translations.
struct PoseRows {
    static constexpr std::size_t kRows = 7;
    std::size_t joints = 0;
    std::size_t stride = 0;  ///< length of a row: a multiple of four
    std::vector<float> values;

    void resize(std::size_t count) {
        joints = count;
        stride = pose_stride(count);
        values.resize(kRows * stride + kPosePadding);  // vectors are read beyond the last joint
    }
    [[nodiscard]] Quat rotation(std::size_t joint) const {
        const float* const v = values.data() + joint;
        return {v[3 * stride], v[0], v[stride], v[2 * stride]};
    }
    [[nodiscard]] Vec3 translation(std::size_t joint) const {
        const float* const v = values.data() + 4 * stride + joint;
        return {v[0], v[stride], v[2 * stride]};
    }
};

/// One character of a crowd: a clip at a time, or two blended.
struct CrowdCharacter {
    const CrowdClip* clip = nullptr;
    float time = 0.0f;                ///< [s], clamped
    const CrowdClip* next = nullptr;  ///< null: not blended
    float next_time = 0.0f;           ///< [s], clamped
    float weight = 0.0f;              ///< of `next`, 0 .. 1
    Affine* joints = nullptr;         ///< written: a matrix per joint of the rig
};

/// Poses characters of one skeleton. Without `joint_from_mesh` the result is character_from_joint;
/// with one matrix per joint it is that times the matrix, ready to skin.
void pose_crowd(
    const CrowdRig& rig, std::span<const CrowdCharacter> characters,
    std::span<const Affine> joint_from_mesh = {});
void pose_crowd_scalar(
    const CrowdRig& rig, std::span<const CrowdCharacter> characters,
    std::span<const Affine> joint_from_mesh = {});

// Its steps.

/// Rotations are interpolated linearly between two frames and normalized. Only of the first
/// `max_joints` joints.
void sample_crowd_clip(
    const CrowdClip& clip, float time, PoseRows& rows, std::size_t max_joints = kAllJoints);
void sample_crowd_clip_scalar(
    const CrowdClip& clip, float time, PoseRows& rows, std::size_t max_joints = kAllJoints);

/// From `a` at weight 0 to `b` at 1, along the shorter arcs; `out` may be one of them.
void blend_poses(const PoseRows& a, const PoseRows& b, float weight, PoseRows& out);
void blend_poses_scalar(const PoseRows& a, const PoseRows& b, float weight, PoseRows& out);

/// Matrices of one character, in plain C++: the products of compute_joint_matrices() in its order.
void compute_crowd_joints(
    const CrowdRig& rig, const PoseRows& rows, std::span<Affine> joints,
    std::span<const Affine> joint_from_mesh = {});
/// Those of several, whose rows have the same size, in the lanes of vectors.
void compute_crowd_joints(
    const CrowdRig& rig, std::span<const PoseRows* const> rows, std::span<Affine* const> joints,
    std::span<const Affine> joint_from_mesh = {});

/// Floats in a vector of this machine: 16 with AVX-512.
[[nodiscard]] std::size_t pose_vector_floats();

}  // namespace limn
