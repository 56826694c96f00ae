#pragma once

#include "content/bake/motion/contact_detection.h"
#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/result.h"
#include "ecs/components/skeleton.h"

#include <cstddef>
#include <string>

namespace limn {

// A motion recorded on one body, for a body with other proportions and another rest pose.
//
// Poses are copied as body_map.h says. A planted foot is pinned where its contact begins, by the
// closed form of two links; where the leg is too short the hips are lowered; after a contact the
// correction fades. Unequal arms: the hands may follow their scaled way instead of the angles
// (`hands`; importance as in H. Shin et al., "Computer Puppetry", 2001). Not done: limbs that
// penetrate the body.

struct RetargetOptions {
    bool pin_feet = true;
    float fade = 0.15f;            ///< after a contact [s]
    float hands = 0.0f;            ///< importance of the way of the hands over angles, 0 .. 1
    ContactOptions contacts = {};  ///< for clips without contacts
};

struct RetargetReport {
    float scale = 1;           ///< leg length of the target over that of the source
    std::size_t joints = 0;    ///< of the target that follow a joint of the source
    std::size_t contacts = 0;  ///< pinned
    float slide_before = 0;    ///< largest way of a planted foot without pins [m]
    float slide = 0;           ///< with them [m]
    float lowered = 0;         ///< most that the hips were lowered [m]
};

/// The clip for `target`, with keys at the rate of the source's and its contacts and events. Fails
/// with one line where no joints correspond.
[[nodiscard]] Result<ClipData> retarget_motion(
    const SkeletonMotion& source, const SkeletonData& target, const RetargetOptions& options = {},
    RetargetReport* report = nullptr);

/// Joint of the source that each joint of the target follows; -1: none.
[[nodiscard]] std::vector<std::int32_t>
match_joints(const SkeletonData& source, const SkeletonData& target);

/// Largest distance of a joint from its position at the beginning of a contact, of all contacts
/// [m].
[[nodiscard]] float find_slide(
    const SkeletonData& skeleton, const MotionFrames& frames,
    std::span<const ClipContact> contacts);

}  // namespace limn
