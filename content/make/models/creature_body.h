#pragma once

#include "content/make/models/creature.h"

#include <array>

namespace limn {

// Implicit body of the creature: blended rounded cones around its joints, and the colors of its
// fur. All for a height of 0.45 m [m].

/// Signed distance to the whole body; < 0 inside.
[[nodiscard]] float creature_distance(const Vec3& p);

/// Signed distance to the parts of each joint, without blending.
[[nodiscard]] std::array<float, kCreatureJoints> creature_part_distances(const Vec3& p);

/// Linear color of fur, nose and claws.
[[nodiscard]] Vec3 creature_color(const Vec3& p, const Vec3& normal);

/// Length of fur, relative to the longest: that of the tail.
[[nodiscard]] float creature_fur_length(const Vec3& p);

/// Linear color at this angle from the view axis of the eye [rad].
[[nodiscard]] Vec3 creature_eye_color(float angle);

/// UV chart of `p`: 0 the trunk from nose to tail, 1 .. 4 the legs.
[[nodiscard]] int creature_chart(const Vec3& p);

/// u: around the bones of the chart, 0 .. 1; v: along them, 0 .. 1.
[[nodiscard]] Vec2 creature_chart_uv(int chart, const Vec3& p);

/// Maps `uv` of a chart to the texture that all charts share.
[[nodiscard]] Vec2 atlas_uv(int chart, const Vec2& uv);

}  // namespace limn
