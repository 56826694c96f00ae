#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

namespace limn {

// Corrective shapes of joints that bend: a morph target named "bend JOINT" follows the angle of
// that joint about its first axis of SkeletonData::freedoms, to the side of its wider limit. Where
// two bones share a vertex half and half, linear blend skinning by an angle a moves it to cos(a /
// 2) of its distance from the joint; what lacks, before the joints move it, is 1 / cos(a / 2) - 1.
// After J. Lewis, M. Cordner, N. Fong, "Pose Space Deformation" (2000).
// Techniques: char.skin-defects

inline constexpr std::string_view kBendShapePrefix = "bend ";

/// Where the shape is whole: 2 / 3 pi [rad].
inline constexpr float kFullBend = 2.0943951f;

/// Weight of the shape at an angle [rad]: 0 straight or bent back, 1 from kFullBend on.
[[nodiscard]] inline float bend_shape_weight(float angle) {
    if (!(angle > 0)) {  // NaN: 0
        return 0;
    }
    return std::min(1 / std::cos(0.5f * std::min(angle, kFullBend)) - 1, 1.0f);
}

}  // namespace limn
