#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <string>
#include <vector>

namespace limn {

// Poses set by hand at times: forward kinematics for creatures that cannot be recorded. The clip
// that they make is sampled as any other.
// Techniques: anim.pose-keys, char.fk-keypose

/// A joint off its rest pose: rotation = rest * turn, translation = rest + shift.
struct KeyedJoint {
    std::string joint{};
    Quat turn = {1, 0, 0, 0};
    Vec3 shift = {0, 0, 0};
};

LIMN_FIELDS(KeyedJoint) {
    LIMN_FIELD(joint, "by name");
    LIMN_FIELD(turn, "rotation from the rest pose, in the joint's space");
    LIMN_FIELD(shift, "translation from the rest pose, in the parent's space", "m");
}

/// The pose at a time.
struct PoseKey {
    float time = 0.0f;
    std::vector<KeyedJoint> joints{};
};

LIMN_FIELDS(PoseKey) {
    LIMN_FIELD(time, "in the animation, later than the key before", "s", 0, 3600);
    LIMN_FIELD(joints, "all others are at rest");
}

/// With a Skeleton: animates it by these keys at the time of its ClipPlayer, in place of that
/// one's clip. Without a ClipPlayer it has the first pose; without keys, the rest pose. A
/// MotionGraph takes precedence.
struct PoseKeys {
    std::vector<PoseKey> keys{};
    bool smooth = false;
};

LIMN_FIELDS(PoseKeys) {
    LIMN_FIELD(keys, "poses, by time");
    LIMN_FIELD(
        smooth, "passes through the keys without corners, and starts and ends at rest; false: "
                "each joint turns at a constant speed from key to key");
}

/// The clip of the keys for every joint that one of them moves, with joints by index. Fails with
/// one line on times that do not increase (with the index of the key), unknown joints, numbers that
/// are not finite.
[[nodiscard]] Result<ClipData> make_pose_clip(const SkeletonData& skeleton, const PoseKeys& keys);

/// What the keys of a character were made to; never saved.
struct PoseKeysState {
    SkeletonId skeleton{};
    ClipData clip{};  ///< without sheets: the rest pose
};
template <>
struct ComponentTraits<PoseKeysState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
