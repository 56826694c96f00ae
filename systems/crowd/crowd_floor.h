#pragma once

#include "ecs/base/math.h"
#include "systems/characters/grounds.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

/// The grounds of a step, for many walkers: with the boxes of their meshes in the world, so that
/// each walker looks at those alone that are below or above it.
struct CrowdFloor {
    std::vector<PlacedGround> grounds{};
    std::vector<Bounds> boxes{};  ///< unbounded for height fields and planes
};

[[nodiscard]] CrowdFloor place_floor(const GroundQueries& queries);

/// Height of the highest ground on the vertical line through a point, at most `climb` [m] above or
/// below it; none where there is none, or the point is not finite.
[[nodiscard]] std::optional<float>
find_floor(const CrowdFloor& floor, const Vec3& point, float climb);

/// The height [m] of a walker after `dt` [s], on its way to that of its floor: no steeper than a
/// slope of 50 degrees at its `speed` [m/s], so that steps do not jolt it; one that stands settles.
[[nodiscard]] float follow_floor(float height, float floor, float speed, float dt);

}  // namespace limn
