#pragma once

#include "content/make/head/head.h"
#include "ecs/base/math.h"

#include <span>

namespace limn {

// The skin of a head as an implicit surface: solids that blend into one another, sculpted by
// strokes. All in centimeters, on the left side (x >= 0), mirrored; y = 0 is 3.5 cm below the
// pupils, z = 0 near the ears.

// The ball of the left eye and the opening of its lids.
inline constexpr Vec3 kEyeCenter = {3.15f, 3.5f, 7.92f};
inline constexpr float kEyeRadius = 1.3f;
inline constexpr float kLidThickness = 0.17f;

// The jaw turns about this axis, parallel to x (y, z).
inline constexpr Vec2 kJawAxis = {-0.55f, 1.82f};

/// Approximate signed distance near the surface, < 0 inside. `detail` 0: cranium, face and neck
/// only, 1: with nose, lids, lips and all strokes.
[[nodiscard]] float head_distance(const Vec3& p, const HeadShape& shape, float detail);

/// Gradient of head_distance: outwards, approximately unit.
[[nodiscard]] Vec3 head_gradient(const Vec3& p, const HeadShape& shape, float detail);

/// Moves `p` along the gradient onto the surface by `steps` of Newton's method; one suffices for a
/// point close to it.
[[nodiscard]] Vec3 project_to_head(Vec3 p, const HeadShape& shape, float detail, int steps = 3);

/// Likewise along z to the foremost point: for the nose, where gradients would fold the mesh.
[[nodiscard]] Vec3 project_forwards(const Vec3& p, const HeadShape& shape, float detail);
/// The same for many points, faster.
void project_forwards(std::span<Vec3> points, const HeadShape& shape, float detail);

/// Outer edge of the margin of the left lids at `angle` [rad], 0 lateral, pi / 2 up.
[[nodiscard]] Vec3 lid_margin(float angle);

/// Height of the fold of the left upper lid at `x` [cm].
[[nodiscard]] float lid_crease(float x);

/// Rim of the left nostril at `angle`, 0 lateral, pi / 2 towards the tip of the nose; near the
/// surface.
[[nodiscard]] Vec3 nostril_rim(float angle);

/// From 1 at the left corner of the mouth, where `angle` is 0, to -1 at the right one, in even
/// steps, since its corners are sharp.
[[nodiscard]] float across_mouth(float angle);

/// Where the lips touch, at `angle` around the mouth.
[[nodiscard]] Vec3 lip_line(float angle);

/// Height of the red of the upper or the lower lip at `angle`, up to its border [cm].
[[nodiscard]] float lip_height(float angle);

}  // namespace limn
