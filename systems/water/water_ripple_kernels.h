#pragma once

#include <cstddef>
#include <span>

namespace limn {

// The inner loop of ripples. It comes twice: with the widest vectors of the machine (Highway,
// chosen at run time) and as plain C++, `_scalar`, which also does the last few cells. Both do the
// same operations in the same order, without fused multiply-add, so they give the same bits.

/// Three neighboring rows of heights; each pointer is at the row's first cell and may be read one
/// before it and one after the last.
struct RippleRows {
    const float* north = nullptr;
    const float* here = nullptr;
    const float* south = nullptr;
};

/// One sub-step of the wave equation h_tt = c^2 laplace(h) - 2 d h_t for a row of `before.size()`
/// cells, by leapfrog: `before` holds the heights one sub-step earlier and gets those one later.
///   next = h + keep_row keep[x] (h - before) + courant2 L(h)
/// L is the isotropic Laplacian of nine points (Patra and Karttunen 2006), (4 edges + corners - 20)
/// / 6; stable for courant2 = (c dt / cell)^2 <= 3/4. What a cell gains by it a neighbor loses.
void step_ripple_row(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2);
void step_ripple_row_scalar(
    const RippleRows& rows, std::span<float> before, const float* keep, float keep_row,
    float courant2);

}  // namespace limn
