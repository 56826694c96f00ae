#pragma once

#include "content/make/head/head_action_units.h"
#include "ecs/base/math.h"

#include <array>
#include <span>
#include <string_view>

namespace limn {

// Static mouth poses, one per class of sounds that look alike (face.viseme), in the order of
// MPEG-4: weighted sums of action units. Jaw 1 opens the incisors by 15 mm; the tongue bends.

struct UnitWeight {
    std::string_view unit;
    float weight = 0;  ///< 0: the end of the list
};

struct HeadViseme {
    std::string_view name;  ///< "viseme_sil" ...
    std::array<UnitWeight, 6> units = {};
    Vec3 tongue_tip = {};   ///< motion of the tongue's tip [mm]
    float tongue_back = 0;  ///< rise of its back [mm]
};

[[nodiscard]] std::span<const HeadViseme> head_visemes();

/// Offset by which the pose moves `point` [cm].
[[nodiscard]] Vec3
viseme_offset(const HeadViseme& viseme, const HeadPoint& point, const HeadShape& shape);

}  // namespace limn
