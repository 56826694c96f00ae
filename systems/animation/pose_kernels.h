#pragma once

#include "ecs/base/math.h"

#include <span>

namespace limn {

// The inner loop of poses: a SIMD version for the machine's widest vectors (Highway, dispatched at
// run time) and a plain C++ one, `_scalar`, which also handles the remainder. Both perform the same
// operations in the same order, without fused multiply-add and libm, so results are bit-identical
// on every machine.

/// out[i] = slerp of the unit quaternions from[i] and to[i] at `u` in 0 .. 1, along the shorter arc
/// (anim.slerp); unit, error at most 3e-7. All spans have the same length; `out` may be `from`.
void slerp_rotations(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out);
void slerp_rotations_scalar(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out);

}  // namespace limn
