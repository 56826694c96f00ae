#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/components/skeleton.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Finds the intervals in which feet are planted: slow and low, with hysteresis and minimum
// durations so that noise neither makes nor breaks a contact (char.walk-retarget, step 1).

struct ContactOptions {
    float speed = 0.25f;        ///< a contact begins below it [leg lengths/s]
    float root_speed = 0.1f;    ///< or below this fraction of the root's mean speed
    float height = 0.06f;       ///< and below it above the lowest point nearby [leg lengths]
    float release = 1.6f;       ///< a contact ends above the thresholds times this, >= 1
    float min_contact = 0.08f;  ///< shorter ones are dropped [s]
    float min_flight = 0.06f;   ///< shorter gaps between two are closed [s]
    float cutoff = 12.0f;       ///< low-pass of the paths [Hz]; 0: none
};

/// Contacts of these joints, ascending by begin.
[[nodiscard]] std::vector<ClipContact> detect_contacts(
    const SkeletonData& skeleton, const MotionFrames& frames, std::span<const std::uint16_t> joints,
    const ContactOptions& options = {});

}  // namespace limn
