#pragma once

#include "ecs/components/crowd.h"
#include "ecs/query.h"
#include "systems/animation/ik/placements.h"
#include "systems/crowd/crowd_barrier.h"

#include <vector>

namespace limn {

/// The obstacle of an entity, on the ground.
[[nodiscard]] CrowdBarrier place_obstacle(const CrowdObstacle& obstacle, const Affine& world);

/// Those of all entities with a Transform, in their order; without those that are not finite.
[[nodiscard]] std::vector<CrowdBarrier>
place_obstacles(const Query<const CrowdObstacle>& obstacles, const Placements& placements);

/// Turns an upright rotation, whose front is +z, toward a direction of the ground, x and z, by at
/// most `angle` [rad]; 0: not at all.
[[nodiscard]] Quat turn_heading(const Quat& rotation, const Vec2& toward, float angle);

/// Playback rate of a clip of `duration` [s] in which a character covers `stride` [m], at a speed.
[[nodiscard]] float stride_rate(float speed, float stride, float duration);

}  // namespace limn
