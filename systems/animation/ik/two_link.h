#pragma once

#include "ecs/base/math.h"

#include <array>

namespace limn {

// Inverse kinematics of two links in closed form, by the law of cosines: an arm or a leg in its
// plane. The first link starts at the origin, at angle `first` from +x, the second one at angle
// `second` from the first.
// After A. Watt, F. Policarpo, "Advanced Game Development with Programmable Graphics Hardware"
// (2005), appendix 9.1.
// Techniques: char.ik-two-link

struct TwoLinkAngles {
    float first = 0.0f;   ///< [rad]
    float second = 0.0f;  ///< -pi .. pi [rad]
};

/// Angles for which the tip is at `target` or, out of reach, as close as possible. `bends_back`:
/// the solution with a negative second angle. `previous_first` is kept where any first angle would
/// do: for a target at the origin, or not finite.
[[nodiscard]] TwoLinkAngles solve_two_link(
    const Vec2& target, float first_length, float second_length, bool bends_back = false,
    float previous_first = 0.0f);

[[nodiscard]] Vec2
two_link_tip(const TwoLinkAngles& angles, float first_length, float second_length);

/// Columns of d(tip) / d(first, second); its determinant is first_length second_length sin(second).
[[nodiscard]] std::array<Vec2, 2>
two_link_jacobian(const TwoLinkAngles& angles, float first_length, float second_length);

/// `distance` to the goal, shortened over the last `softness` meters of the reach so that a limb
/// straightens smoothly instead of snapping: always less than `reach`, with a continuous
/// derivative. 0: cut off at `reach`.
[[nodiscard]] float soft_reach(float distance, float reach, float softness);

}  // namespace limn
