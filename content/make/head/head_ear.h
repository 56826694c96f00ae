#pragma once

#include "content/make/head/head_layout.h"
#include "ecs/base/math.h"

namespace limn {

// An ear: a plane that leans back and stands out from the head, bounded by an outline around the
// concha, with a relief of its parts on the front: helix and its crus, scapha, antihelix with two
// crura, tragus, antitragus, the notch between them, concha and lobe. Loops run from the head up
// the back to the outline, then over the relief to the concha; in front of the ear they run from
// the cheek over the tragus. After H. Gray, "Anatomy of the Human Body", and L. Farkas (1994):
// 62 x 36 mm, its axis 16 degrees from vertical.

/// Position on the left side of a vertex of HeadLoops::Ear [cm]; `root`: the center of the concha
/// in the plane of the ear.
[[nodiscard]] Vec3 ear_point(const HeadVertex& vertex, const Vec3& root);

/// How much the vertex belongs to the cheek instead of the ear, 0 .. 1.
[[nodiscard]] float ear_on_cheek(const HeadVertex& vertex);

/// Height of the front above the plane of the ear; `at`: from the concha, backwards and up [cm].
[[nodiscard]] float ear_relief(const Vec2& at);

/// Radius of the ear's outline from the concha [cm]; angle 0 backwards, pi / 2 up.
[[nodiscard]] float ear_outline(float angle);

}  // namespace limn
