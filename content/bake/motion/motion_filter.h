#pragma once

#include "content/bake/motion/skeleton_motion.h"
#include "ecs/base/math.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Removes noise from recorded motion: a Butterworth low-pass filter of order 2, run forward and
// backward, so that nothing is delayed. Constant and linear motions pass unchanged; impacts shorter
// than 1 / cutoff are blurred. After D. Winter, "Biomechanics and Motor Control of Human Movement".

/// Filters samples at `rate` per second; half of the amplitude of two passes at `cutoff` [Hz] gets
/// through, in terms of power. A cutoff of at least rate / 2 changes nothing.
void low_pass(std::span<double> samples, double rate, double cutoff);

/// The same for each coordinate of a path.
void low_pass(std::span<Vec3> path, float rate, float cutoff);

/// The same for rotations, as unit quaternions that stay in the hemisphere of the previous one.
void low_pass(std::span<Quat> rotations, float rate, float cutoff);

/// Filters the rotations and translations of all joints (char.mocap-cleanup).
void smooth_frames(MotionFrames& frames, float cutoff);

}  // namespace limn
