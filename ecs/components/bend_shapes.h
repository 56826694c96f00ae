#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

namespace limn {

// Corrective shapes of joints that bend: a morph target named "bend JOINT" follows the angle of
// that joint about its first axis of SkeletonData::freedoms, to the side of its wider limit, and
// "bend JOINT axis N" about its N-th one: arms are raised about the second. Where
// two bones share a vertex half and half, linear blend skinning by an angle a moves it to cos(a /
// 2) of its distance from the joint; what lacks, before the joints move it, is 1 / cos(a / 2) - 1.
// After J. Lewis, M. Cordner, N. Fong, "Pose Space Deformation" (2000).
// Techniques: char.skin-defects

inline constexpr std::string_view kBendShapePrefix = "bend ";

/// What the name of a shape says.
struct BendName {
    std::string_view joint;
    std::size_t axis = 0;  ///< index among the joint's axes of freedom
};

/// Of a name that begins with kBendShapePrefix.
[[nodiscard]] inline BendName parse_bend_name(std::string_view name) {
    constexpr std::string_view kAxis = " axis ";
    BendName bend = {.joint = name.substr(kBendShapePrefix.size())};
    const std::size_t at = bend.joint.rfind(kAxis);
    if (at != std::string_view::npos && at + kAxis.size() + 1 == bend.joint.size()
        && bend.joint.back() >= '1' && bend.joint.back() <= '9') {
        bend.axis = static_cast<std::size_t>(bend.joint.back() - '1');
        bend.joint = bend.joint.substr(0, at);
    }
    return bend;
}

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
