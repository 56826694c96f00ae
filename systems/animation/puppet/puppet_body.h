#pragma once

#include "ecs/components/body_map.h"
#include "ecs/components/puppet.h"
#include "ecs/components/skeleton.h"
#include "ecs/components/transform.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Poses of a performer on the body of a puppet, one at a time.
// Techniques: char.puppetry, char.retarget-body

/// A limb of three joints and, of a leg, the toes; 0xffff: there is none.
struct PuppetLimb {
    std::uint16_t root = 0xffff;
    std::uint16_t middle = 0xffff;
    std::uint16_t tip = 0xffff;
    std::uint16_t toes = 0xffff;
};

/// What a puppet needs to know of both bodies, and its pose; never saved.
struct PuppetBody {
    SkeletonId performer{};  ///< that the rest is for
    SkeletonId puppet{};
    BodyMap map = {};
    Vec3 shift = {0, 0, 0};  ///< from scaled points of the performer to the puppet's [m]
    std::array<std::uint16_t, 7> joints{};  ///< of the performer, as in PuppetPoint; or 0xffff
    std::array<std::uint16_t, 2> hips{};    ///< thighs of the puppet; or its root, twice
    std::array<std::uint16_t, 2> thighs{};  ///< of the performer; or its root, twice
    std::uint16_t root = 0;                 ///< of the puppet's body
    Vec3 left = {1, 0, 0};                  ///< of the puppet at rest, unit
    float leg = 0;                          ///< of the performer [m]
    float standing = 0;                     ///< height of its toes, or ankles, at rest [m]
    std::array<PuppetLimb, 2> legs{};       ///< of the puppet; left, right
    std::array<PuppetLimb, 2> arms{};
    LocalPose pose = {};                ///< of the puppet
    std::vector<Affine> matrices = {};  ///< puppet_from_joint of `pose`
    std::vector<Quat> turns = {};       ///< scratch: of the performer's joints
    std::vector<Quat> outer = {};       ///< scratch
};
template <>
struct ComponentTraits<PuppetBody> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

/// Measures both skeletons.
void measure_puppet(const SkeletonData& performer, const SkeletonData& puppet, PuppetBody& body);

/// The performer's joints as rotations in its space, and its points.
void read_performer(
    const PuppetBody& body, std::span<const Affine> joints, std::span<Quat> turns,
    std::array<Vec3, 7>& points);

/// Sets `body.pose` to the pose of the performer: `turns` and `points`, as read_performer()'s.
/// `hands`: importance of their way, 0 .. 1.
void pose_puppet(
    const SkeletonData& puppet, std::span<const Quat> turns, const std::array<Vec3, 7>& points,
    float hands, PuppetBody& body);

/// Keeps planted feet of a posed puppet where they are in the space of its parent, and lowers its
/// hips where a leg is too short. `performer`: where it is.
void pin_puppet(
    const SkeletonData& puppet, const Transform& performer, const Transform& transform, float step,
    PuppetState& state, PuppetBody& body);

}  // namespace limn
