#pragma once

#include "systems/animation/ik/chain_jacobian.h"

#include <span>

namespace limn {

// The pseudo-inverse J+ of a Jacobian: J+ dX is the shortest step of the axes that moves the
// effector by dX, in the least-squares sense. Close to singular poses it is damped: a singular
// value s below 2 lambda is inverted as s / (s^2 + lambda^2 (1 - (s / 2 lambda)^2)), so that no
// step is longer than |dX| / lambda, and poses far from singular ones are solved exactly. From the
// eigenvectors of the smaller one of J J^T and J^T J, by Jacobi's method, in double precision.
// After C. Wampler (1986), Y. Nakamura, H. Hanafusa (1986), and the numerical filtering of A.
// Maciejewski, C. Klein (1988).
// Techniques: char.ik-pinv

/// J+, columns x rows. `damping`: lambda [m]; 0: undamped, directions that the axes cannot move in
/// are left out.
void find_pseudo_inverse(const IkMatrix& jacobian, float damping, IkMatrix& inverse);

/// step = (I - J+ J) step: what is left of a step when nothing may move the effector. For secondary
/// tasks, such as comfortable angles.
void project_to_null_space(
    const IkMatrix& jacobian, const IkMatrix& inverse, std::span<float> step);

}  // namespace limn
