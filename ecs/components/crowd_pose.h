#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// With a Skeleton and a ClipPlayer: poses the character as one of a crowd, from a compressed copy
/// of its clip, 16 at a time, less often far from the camera, and only the joints that its meshes
/// need at their level of detail. Clips that cannot be compressed are sampled as without it.
struct CrowdPose {
    bool compressed = true;
    float full_rate_within = 15.0f;
    float half_rate_within = 40.0f;
};

LIMN_FIELDS(CrowdPose) {
    LIMN_FIELD(
        compressed, "samples a copy of the clip with 48-bit rotations, within 1 mm on a person of "
                    "2 m; false: the clip itself");
    LIMN_FIELD(
        full_rate_within, "distance from the camera up to which it is posed in every step", "m", 0,
        1e6);
    LIMN_FIELD(
        half_rate_within, "up to which in every second step; beyond, in every fourth", "m", 0, 1e6);
}

/// How often a crowd's character is posed, chosen by choose_pose_rates(), which of its joints, by
/// choose_pose_joints(), and from what it fades after its clip was changed.
struct CrowdPoseState {
    std::uint32_t interval = 1;  ///< steps: 1, 2 or 4
    std::uint32_t joints = 0;    ///< the first ones; 0: all
    ClipId clip{};
    float time = 0.0f;
    ClipId from{};
    float from_time = 0.0f;
    float fade = 0.0f;
};

LIMN_FIELDS(CrowdPoseState) {
    LIMN_FIELD(interval, "steps from one pose to the next", "", 1, 4);
    LIMN_FIELD(joints, "how many of its first joints are posed, 0 = all");
    LIMN_FIELD(clip, "what it played in the last step");
    LIMN_FIELD(time, "in that clip", "s");
    LIMN_FIELD(from, "what it played before");
    LIMN_FIELD(from_time, "in that clip", "s");
    LIMN_FIELD(fade, "how much of that is left", "", 0, 1);
}

/// Not copied with a prefab: an instance has no history.
template <>
struct ComponentTraits<CrowdPoseState> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
