#pragma once

#include "content/bake/motion/skeleton_motion.h"

#include <cstddef>
#include <optional>

namespace limn {

// Cuts a clip that repeats without a jump out of a longer one: the interval whose ends are most
// alike, in the positions and velocities of all joints relative to the body, with what differs
// spread over the whole.

struct LoopInterval {
    std::size_t first = 0;  ///< frames
    std::size_t last = 0;   ///< shows the pose of `first` again
    float error = 0;        ///< root mean square distance of the joints at its ends [m]
};

/// The best interval of `min_seconds` to `max_seconds` (0: any longer one); nullopt where the
/// motion is shorter. Distance traveled and the direction in which the body faces do not count.
[[nodiscard]] std::optional<LoopInterval> find_loop(
    const SkeletonData& skeleton, const MotionFrames& frames, float min_seconds,
    float max_seconds = 0.0f);

/// The frames of the interval; the last has the pose of the first, but for the way that the body
/// root travels horizontally.
[[nodiscard]] MotionFrames
cut_loop(const SkeletonData& skeleton, const MotionFrames& frames, const LoopInterval& loop);

}  // namespace limn
