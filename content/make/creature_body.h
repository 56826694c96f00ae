#pragma once

#include "content/make/creature.h"

#include <array>

namespace limn {

// What the creature's body is made of: rounded cones and balls around its joints, blended, and
// where which fur grows. All of a creature of 0.45 m [m].

/// Of the whole body; less than 0 inside.
[[nodiscard]] float creature_distance(const Vec3& p);

/// Of the flesh on each joint alone; blends are left out.
[[nodiscard]] std::array<float, kCreatureJoints> creature_flesh(const Vec3& p);

/// Linear, of the fur, the nose and the claws.
[[nodiscard]] Vec3 creature_color(const Vec3& p, const Vec3& normal);

/// Linear, at this angle from where the eye looks [rad].
[[nodiscard]] Vec3 creature_eye_color(float angle);

/// Which piece of the hide `p` is in: 0 the trunk from nose to tail, 1 .. 4 the legs.
[[nodiscard]] int creature_chart(const Vec3& p);

/// u: around the bones of the chart, 0 .. 1; v: along them, 0 .. 1.
[[nodiscard]] Vec2 creature_chart_uv(int chart, const Vec3& p);

/// Side by side in one image.
[[nodiscard]] Vec2 place_in_atlas(int chart, const Vec2& uv);

}  // namespace limn
