#pragma once

#include "ecs/base/math.h"

#include <span>

namespace limn {

// The inner loop of poses. It comes twice: with the widest vectors of the machine (Highway, chosen
// at run time) and as plain C++, `_scalar`, which also does the last few. Both do the same
// operations in the same order, without fused multiply-add and without libm, so they give the same
// bits, on every machine.

/// out[i] = from[i] and to[i], unit, blended on the shorter great arc at `u` in 0 .. 1
/// (anim.slerp); length 1, off by at most 3e-7. All spans have one length; `out` may be `from`.
void slerp_rotations(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out);
void slerp_rotations_scalar(
    std::span<const Quat> from, std::span<const Quat> to, float u, std::span<Quat> out);

}  // namespace limn
