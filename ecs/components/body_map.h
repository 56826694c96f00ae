#pragma once

#include "ecs/base/math.h"
#include "ecs/components/humanoid.h"
#include "ecs/components/skeleton.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// How the pose of one body becomes that of another with other proportions and another rest pose.
//
// Joints correspond by name, else by the part of the body that they are (humanoid.h); backs and
// necks with other numbers of joints share the bend. Rotations are copied relative to rest, after
// each limb of the target at rest is aligned with the source's: a T-pose and an A-pose give the
// same motion. The way of the hips is scaled by the ratio of leg lengths.
// Techniques: char.retarget-body

/// What a joint of the target follows: between two joints of the source.
struct FollowedJoint {
    std::int32_t first = -1;  ///< -1: nothing
    std::int32_t second = -1;
    float u = 0;  ///< 0: the first; 1: the second
};

/// One per joint of the target.
[[nodiscard]] std::vector<FollowedJoint>
match_body_joints(const SkeletonData& source, const SkeletonData& target);

/// A skeleton with what retargeting measures on it; `skeleton` has to outlive it.
struct BodySize {
    const SkeletonData& skeleton;
    BodyJoints joints;
    std::vector<Affine> rest;          ///< skeleton_from_joint
    std::vector<Quat> rest_rotations;  ///< in the space of the skeleton
    std::uint16_t root = 0;            ///< of the body: what moves when the person walks
    float leg = 0;                     ///< length [m]; 0: none, nor the following
    std::vector<bool> is_foot = {};    ///< ankles and all below
    bool stands_on_zero = true;        ///< at rest; else somewhere else, as on the hips' height
    float floor = 0;                   ///< the lowest joint of the feet at rest, or y = 0 [m]
    float ankle = 0;                   ///< height of the ankles above it [m]

    explicit BodySize(const SkeletonData& of);

    [[nodiscard]] Vec3 rest_position(std::uint16_t joint) const {
        return transform_point(rest[joint], Vec3(0));
    }
    /// Height of the lowest joint of the feet; skeleton_from_joint in `matrices`.
    [[nodiscard]] float find_lowest(std::span<const Affine> matrices) const;
    /// Midpoint of the hips, or the root without legs.
    [[nodiscard]] Vec3 middle(std::span<const Affine> matrices) const;

  private:
    void measure_feet();
};

/// Everything that a pose needs on its way from one body to the other.
struct BodyMap {
    std::vector<FollowedJoint> followed;  ///< one per joint of the target
    std::vector<Quat> alignments;         ///< turns the target's rest pose into the source's
    std::vector<Quat> source_rest;        ///< rotations at rest, in the space of the skeleton
    std::vector<Quat> target_rest;        ///< likewise
    float scale = 1;                      ///< leg length of the target over that of the source

    /// Joints of the target that follow one of the source.
    [[nodiscard]] std::size_t count() const;
};
[[nodiscard]] BodyMap make_body_map(const BodySize& source, const BodySize& target);

/// From scaled positions of the source to those of the target: the ankles of a standing person are
/// at their own height above the ground. `ground`: height of the source's [m].
[[nodiscard]] Vec3
find_body_shift(const BodySize& source, const BodySize& target, float scale, float ground = 0);

/// Sets the rotations of the joints of `pose`, of the skeleton `target`, that follow a joint whose
/// `turns`, rotations in the space of the skeleton, are those of the source; in the hemisphere of
/// the rotation that they have. `outer`: scratch memory.
void map_body_turns(
    const BodyMap& map, const SkeletonData& target, std::span<const Quat> turns,
    std::vector<Quat>& outer, std::span<Quat> local);

}  // namespace limn
