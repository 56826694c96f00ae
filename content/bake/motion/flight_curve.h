#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/math.h"
#include "ecs/components/skeleton.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The way of a foot between two plants of a recorded walk, as a curve without size that a walk made
// by inverse kinematics can follow with any legs (char.walk-retarget).

struct FlightCurve {
    std::uint16_t joint = 0;
    float begin = 0;   ///< end of the plant before [s]
    float end = 0;     ///< begin of the next plant [s]
    float length = 0;  ///< from plant to plant, horizontally [m]
    float height = 0;  ///< of the highest point above the line between the plants [m]
    /// At equal times from begin to end: forward, 0 to 1 of `length`, and height, at most 1 of
    /// `height`.
    std::vector<Vec2> points;
};

/// A flight for each two consecutive contacts of a joint, ascending by begin, with `samples` >= 2
/// points.
[[nodiscard]] std::vector<FlightCurve> extract_flights(
    const SkeletonData& skeleton, const MotionFrames& frames, std::span<const ClipContact> contacts,
    std::size_t samples = 33);

/// Point of the curve at u, 0 to 1, linear in between.
[[nodiscard]] Vec2 sample_flight(const FlightCurve& curve, float u);

}  // namespace limn
