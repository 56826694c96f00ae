#pragma once

#include "content/make/person/person_skeleton.h"

namespace limn {

// The shape of a body as tables of cross-sections: half widths and depths along the trunk, the legs
// and the arms, between those of a woman and a man and by build. Breadths and circumferences after
// Gordon et al. (1989); muscles by eye. Clothes are the same at a distance. Left side, in meters at
// the reference height.

/// A cross-section: an ellipse with different halves in front and behind.
struct BodySection {
    float width = 0;  ///< half
    float front = 0;  ///< from the axis
    float back = 0;
};

/// Of the trunk at `height`, around (0, height, 0).
[[nodiscard]] BodySection trunk_section(const PersonFrame& frame, float height);

/// On the trunk at `angle`, 0 in front, pi / 2 left, grown by `ease` from the body. Near the neck,
/// rings tilt: lower in front.
[[nodiscard]] Vec3 trunk_point(const PersonFrame& frame, float height, float angle, float ease);
/// On a given section. `drape` 1: cloth that hangs from the chest, 0: skin.
[[nodiscard]] Vec3 trunk_point(
    const BodySection& section, const PersonFrame& frame, float height, float angle, float drape);

/// The axis of the leg at `height`.
[[nodiscard]] Vec3 leg_axis(const PersonFrame& frame, float height);
[[nodiscard]] BodySection leg_section(const PersonFrame& frame, float height);
/// On a section of a leg at `angle`, 0 in front, pi / 2 outside.
[[nodiscard]] Vec3
leg_point(const BodySection& section, const PersonFrame& frame, float height, float angle);

/// Axes of the arm, bent at the elbow, `along` it from the shoulder, and the point of its axis.
struct ArmPlace {
    Vec3 center = {};
    LimbAxes axes;
};
[[nodiscard]] ArmPlace arm_place(const PersonFrame& frame, float along);
/// Half widths toward the thumb and toward the back of the hand.
[[nodiscard]] Vec2 arm_radii(const PersonFrame& frame, float along);
/// On an arm of `radii`, at `angle`: 0 toward the thumb, pi / 2 toward the back of the hand.
[[nodiscard]] Vec3 arm_point(const PersonFrame& frame, float along, float angle, const Vec2& radii);

}  // namespace limn
