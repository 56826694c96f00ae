#pragma once

#include "content/make/four.h"
#include "content/make/head/head.h"
#include "ecs/base/math.h"

namespace limn {

// The shoulders below a head: base of the neck, trapezius, collar bones with the notch between
// them, the round of the shoulders and upper chest and back, down to the plane kShouldersEnd, which
// cuts torso and upper arms in one ring above the armpits. Added to the surface of head_surface.h.
// Breadths and heights after Gordon et al., "Anthropometric Survey of U.S. Army Personnel" (1989).
// All in centimeters.

inline constexpr int kShoulderRows = 36;     ///< of quads below those of the head
inline constexpr float kShouldersEnd = -27;  ///< y of the ring where a body begins

/// The place on neutral shoulders of `p`, which is on those of `shape`; and the other way.
[[nodiscard]] Vec3 to_neutral_shoulders(const Vec3& p, const HeadShape& shape);
[[nodiscard]] Vec3 from_neutral_shoulders(const Vec3& p, const HeadShape& shape);

/// Adds neutral shoulders to the surface that is `distance` away from `p`, without details. Number:
/// float or Four.
template <typename Number>
[[nodiscard]] Number join_shoulders(const Number& distance, const PointOf<Number>& p);

/// How much bones and muscles raise their surface at `p`.
template <typename Number>
[[nodiscard]] Number shoulder_relief(const PointOf<Number>& p, const HeadShape& shape);

/// Where a vertex begins, before it is wrapped: below `neck`, on the ring where the head ends;
/// `turn`: evenly around the ring, 0 in front, pi / 2 left; `down`: 0 at the neck, 1 at the end.
[[nodiscard]] Vec3 shoulder_start(const Vec3& neck, float turn, float down);

/// How much skin at `p` turns with the head, 0 .. 1: less and less down the neck.
[[nodiscard]] float turns_with_head(const Vec3& p);

}  // namespace limn
