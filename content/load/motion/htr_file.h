#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace limn {

// Motion capture files of Motion Analysis, HTR (hierarchical translation and rotation), which
// unlike BVH have a scale per bone and frame and rotations at rest:
//
//     [Header]
//     NumFrames 2
//     DataFrameRate 30
//     EulerRotationOrder ZXY         the first is the outermost
//     CalibrationUnits mm            or cm, m, in
//     RotationUnits Degrees          or Radians
//     GlobalAxisofGravity Y          or Z
//     [SegmentNames&Hierarchy]
//     Hips GLOBAL                    child, parent
//     LeftHip Hips
//     [BasePosition]
//     Hips 0 900 0 0 0 0 100         translation, rotation, bone length
//     LeftHip 100 0 0 0 0 0 400
//     [Hips]
//     1 0 0 0 10 20 30 1             frame, translation, rotation, scale
//     2 0 0 0 10 20 30 1
//
// Translations add to the base, rotations follow it: base * frame. A scale applies to the bone's
// skin and to everything below it. `#` begins a comment.

struct HtrLimits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;
    std::size_t max_joints = 65'000;
    std::size_t max_frames = 10'000'000;
    std::size_t max_keys = std::size_t{1} << 26;  ///< of all joints
};

/// The skeleton and its clip in meters, with +y up. Fails with one line: file, line, what was found
/// and what was expected. A second root becomes a child of the first joint.
[[nodiscard]] Result<SkeletonMotion>
parse_htr(std::string_view text, const std::string& file, const HtrLimits& limits = {});

[[nodiscard]] Result<SkeletonMotion> load_htr(const std::string& path);

}  // namespace limn
