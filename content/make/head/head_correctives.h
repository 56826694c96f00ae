#pragma once

#include "content/make/head/head_action_units.h"
#include "ecs/base/math.h"

#include <span>
#include <string_view>

namespace limn {

// What action units of a head do beyond straight lines. Lids and the jaw turn: an in-between adds,
// halfway, what the chord of a morph target lacks of the arc. While one unit has closed an eye,
// lids follow no other: a corrective takes back what that one does to them.

struct HeadCorrective {
    std::string_view unit;   ///< closes the eye, or turns
    std::string_view other;  ///< empty: the in-between of `unit` at half its weight
};

[[nodiscard]] std::span<const HeadCorrective> head_correctives();

/// How far `point` moves beyond the units themselves, on both sides [cm]: while `unit` has weight
/// 1/2, or both have weight 1.
[[nodiscard]] Vec3
corrective_offset(const HeadCorrective& corrective, const HeadPoint& point, const HeadShape& shape);

}  // namespace limn
