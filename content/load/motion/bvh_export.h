#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "content/load/motion/bvh_file.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

/// The motion as a BVH file of `scale` meters per unit, one row per 1 / rate seconds; rotations in
/// the order Z, X, Y. BVH has no rotations at rest: joints are turned so that theirs is none, which
/// leaves all positions as they are. Animated scales are lost. A first joint that is only the scene
/// of a glTF file is left out; tips of chains named "..._end" become end sites.
[[nodiscard]] BvhFile make_bvh_file(const SkeletonMotion& motion, float rate, float scale = 0.01f);

/// make_bvh_file at the rate of the clip into a file, which appears complete or not at all.
[[nodiscard]] Status save_bvh(const std::string& path, const SkeletonMotion& motion);

}  // namespace limn
