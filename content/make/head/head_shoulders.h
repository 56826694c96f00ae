#pragma once

#include "content/make/four.h"
#include "content/make/head/head.h"
#include "ecs/base/math.h"

namespace limn {

// The shoulders below a head: base of the neck, trapezius, collar bones with the notch between
// them, the shoulders themselves and upper chest and back, down to the plane kShouldersEnd, which
// cuts torso and upper arms in one ring above the armpits. Added to the surface of head_surface.h.
// Breadths and heights after Gordon et al., "Anthropometric Survey of U.S. Army Personnel" (1989).
// All in centimeters.

inline constexpr int kShoulderRows = 36;     ///< of quads below those of the head
inline constexpr float kShouldersEnd = -27;  ///< y of the ring where a body begins

/// Maps a point on the shoulders of `shape` to neutral shoulders, and back.
[[nodiscard]] Vec3 to_neutral_shoulders(const Vec3& p, const HeadShape& shape);
[[nodiscard]] Vec3 from_neutral_shoulders(const Vec3& p, const HeadShape& shape);

/// Adds neutral shoulders without details to the surface at `distance` from `p`. Number: float or
/// Four.
template <typename Number>
[[nodiscard]] Number join_shoulders(const Number& distance, const PointOf<Number>& p);

/// How much bones and muscles raise the surface at `p`.
template <typename Number>
[[nodiscard]] Number shoulder_relief(const PointOf<Number>& p, const HeadShape& shape);

/// Initial position of a vertex, before it is wrapped: below `neck`, on the ring where the head
/// ends; `turn`: around the ring, 0 in front, pi / 2 left; `down`: 0 at the neck, 1 at the end.
[[nodiscard]] Vec3 shoulder_start(const Vec3& neck, float turn, float down);

/// How much skin at `p` turns with the head, 0 .. 1: decreasing down the neck.
[[nodiscard]] float turns_with_head(const Vec3& p);

}  // namespace limn
