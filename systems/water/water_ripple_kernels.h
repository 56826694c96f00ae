#pragma once

#include <cstddef>
#include <span>

namespace limn {

// The inner loop of ripples: a SIMD version for the machine's widest vectors (Highway, dispatched
// at run time) and a plain C++ one, `_scalar`, which also handles the remainder. Both perform the
// same operations in the same order, without fused multiply-add, so results are bit-identical.

/// Three neighboring rows of heights; each points to the row's first cell and is readable from one
/// cell before it to one after the last.
struct RippleRows {
    const float* north = nullptr;
    const float* here = nullptr;
    const float* south = nullptr;
};

/// One leapfrog substep of the wave equation h_tt = c^2 laplace(h) - 2 d h_t for a row of
/// `before.size()` cells: `before` holds the heights of the previous substep and receives the next.
///   next = h + keep_row keep[x] (h - before) + courant2 L(h)
/// L is the isotropic nine-point Laplacian (Patra and Karttunen 2006), (4 edges + corners - 20
/// center) / 6; stable for courant2 = (c dt / cell)^2 <= 3/4. Conserves volume.
void step_ripple_row(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2);
void step_ripple_row_scalar(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2);

}  // namespace limn
