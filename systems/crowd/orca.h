#pragma once

#include "ecs/base/math.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// Optimal reciprocal collision avoidance in the plane: each neighbor forbids a half-plane of
// velocities, of which a walker takes its share and the neighbor the rest; the velocity nearest to
// the preferred one is the optimum of a linear program. Where no velocity meets all half-planes,
// that of walkers is exceeded least.
// After J. van den Berg, S. Guy, M. Lin, D. Manocha, "Reciprocal n-Body Collision Avoidance", ISRR
// 2009 (2011). Nothing in it resolves deadlocks: see step_crowd.h.

/// A walker as its neighbors see it: a disc.
struct WalkerDisc {
    Vec2 position = {0, 0};  ///< [m]
    Vec2 velocity = {0, 0};  ///< [m/s]
    float radius = 0;        ///< [m]
};

/// The velocities v with dot(normal, v) >= offset.
struct VelocityPlane {
    Vec2 normal = {1, 0};  ///< unit
    float offset = 0;      ///< [m/s]
};

inline constexpr float kHeadOnSpeed =
    0.2f;  ///< lateral, at which walkers meet head-on [radii a horizon]
inline constexpr float kCenteredSpeed = 1e-6f;  ///< from the center, without a direction [m/s]

/// How a walker avoids another.
struct AvoidOptions {
    float horizon = 2;          ///< without contact for so long [s]
    float contact_time = 0.2f;  ///< overlapping ones are apart after it [s]
    float share = 0.5f;         ///< part of the change of velocity that the walker takes, 0 .. 1
    float side = 0;       ///< where they meet head-on: 1 passes counterclockwise, -1 clockwise
    Vec2 apart = {1, 0};  ///< unit: the direction in which it leaves a coincident one
};

[[nodiscard]] VelocityPlane
avoid_walker(const WalkerDisc& walker, const WalkerDisc& other, const AvoidOptions& options);

/// The half-plane that keeps a walker from an obstacle at `distance` [m] (< 0: inside) of its rim
/// in the unit direction `toward`, for `horizon` [s].
[[nodiscard]] VelocityPlane avoid_wall(const Vec2& toward, float distance, float horizon);

/// The velocity nearest to `preferred` that meets all half-planes and is at most `max_speed`. Where
/// there is none, it meets the first `hard` ones, as far as it can, and exceeds the largest of the
/// others as little as possible. At most kMaxVelocityPlanes.
[[nodiscard]] Vec2 solve_velocity(
    std::span<const VelocityPlane> planes, std::size_t hard, const Vec2& preferred,
    float max_speed);

inline constexpr std::size_t kMaxVelocityPlanes = 32;

}  // namespace limn
