#pragma once

#include "content/make/head/head_action_units.h"
#include "ecs/base/math.h"

#include <span>
#include <string_view>

namespace limn {

// Corrective shapes for action units of a head. Lids and the jaw rotate, but a morph target moves
// along a chord: an in-between shape adds the rest of the arc halfway. While one unit closes an
// eye, its lids ignore other units: a corrective cancels their effect on the lids.

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
