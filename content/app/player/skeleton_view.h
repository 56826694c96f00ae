#pragma once

#include "content/load/motion/curve_plot.h"
#include "ecs/base/math.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/skeleton.h"
#include "ecs/entity.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

class World;

// A character as the views of `limn play` show it: its skeleton, where its joints were and will be,
// and their angles (char.ghost-view), apart from how they are drawn.

/// A character and what animates it. Points to components and assets, valid until they change.
struct CharacterView {
    Entity entity{};
    const SkeletonData* skeleton = nullptr;
    Affine world_from_character{};
    std::vector<Affine> joints;      ///< character_from_joint, after the last step
    const ClipData* clip = nullptr;  ///< null: it is not known what it will do
    float time = 0.0f;               ///< in the clip [s]
    float speed = 0.0f;              ///< of the clip
    bool loop = false;
};

/// The character that `entity` is, is deformed by, or is below; the only one of the world, if it is
/// none of them. Null: none.
[[nodiscard]] Entity find_character(const World& world, Entity entity);

/// None without a Skeleton or a Pose. The clip of a character with a motion graph, a walk or
/// anything else that changes poses is not known.
[[nodiscard]] std::optional<CharacterView> view_character(const World& world, Entity entity);

/// A moment of a character.
struct CharacterMoment {
    double time = 0.0;  ///< of the simulation [s]
    Affine world_from_character{};
    std::vector<Affine> joints;
};

/// What a character did in its last steps, up to kMoments.
class MotionHistory {
  public:
    static constexpr std::size_t kMoments = 300;

    /// Call after steps; a repeated time is ignored. Begins anew with another character, and when
    /// time goes back.
    void record(const CharacterView& view, double time);
    void clear() { moments_.clear(); }
    [[nodiscard]] const std::vector<CharacterMoment>& moments() const { return moments_; }

  private:
    Entity entity_;
    std::vector<CharacterMoment> moments_;  // by time
};

/// The character `offset` seconds from now: by its clip, where it is now; or, without one, before
/// now, as it was. None if that is not known.
[[nodiscard]] std::optional<CharacterMoment>
moment_at(const CharacterView& view, const MotionHistory& history, float offset);

/// World positions of a joint from `before` seconds before now to `after` seconds after it, 60 a
/// second, as far as they are known.
[[nodiscard]] std::vector<Vec3> trail_of(
    const CharacterView& view, const MotionHistory& history, std::uint16_t joint, float before,
    float after);

/// An axis about which a joint turns: one that its skeleton allows, or one of three.
struct JointAngle {
    std::string name;       ///< "x", "y", "z"; "axis 1" for one that is none of them
    Vec3 axis = {1, 0, 0};  ///< unit, in the joint's space at rest
    float value = 0.0f;     ///< [rad]
    float min = -kPi;
    float max = kPi;
    bool is_limited = false;
};

/// The angles of a turn from the rest pose, about the axes of the joint in their order; of a joint
/// without limits about y, then x, then z.
[[nodiscard]] std::vector<JointAngle>
joint_angles(const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn);
/// The inverse, with values within their limits.
[[nodiscard]] Quat turn_of_angles(std::span<const JointAngle> angles);
/// The nearest turn that the limits of the joint allow.
[[nodiscard]] Quat limit_turn(const SkeletonData& skeleton, std::uint16_t joint, const Quat& turn);

/// Rotation of a joint from its rest pose, in character_from_joint matrices.
[[nodiscard]] Quat
shown_turn(const SkeletonData& skeleton, std::span<const Affine> joints, std::uint16_t joint);

/// Poses of joints relative to their parents.
[[nodiscard]] LocalPose local_pose(const SkeletonData& skeleton, std::span<const Affine> joints);

/// Angles of a joint over time in degrees, one value per 1/60 s from -before to +after; empty where
/// the motion is not known. `begin`: time of the first value from now [s].
struct JointCurves {
    std::vector<ChannelCurve> curves;
    float begin = 0.0f;
};
[[nodiscard]] JointCurves curves_of(
    const CharacterView& view, const MotionHistory& history, std::uint16_t joint, float before,
    float after);

}  // namespace limn
