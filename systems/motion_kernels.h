#pragma once

#include "ecs/components/transform.h"

#include <span>

namespace limn {

// The inner loops of transform, spin and sway, for one chunk of entities each. Every kernel comes
// twice: with the widest vectors of the machine (Highway, chosen at run time) and as plain C++,
// `_scalar`, which also does the last few entities. Both do the same operations in the same order,
// without fused multiply-add and without libm, so they give the same bits, on every machine.

/// Sine of an angle in any quadrant [rad]: reduced in double precision, then the polynomials of
/// Cephes (S. Moshier) in single; off by at most 1e-7 for |angle| < 1e8.
[[nodiscard]] float sine(double angle);
[[nodiscard]] float cosine(double angle);

/// world_from_local of entities without a parent: previous = world, then world = compose(local). An
/// entity that never had a world (previous is all 0) gets the new one for both.
void compose_worlds(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous);
void compose_worlds_scalar(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous);

/// rotation = rotation * (turn by speed * dt about axis), made unit again. An axis of length 0
/// turns nothing.
void turn_rotations(std::span<const Spin> spin, float dt, std::span<Transform> transform);
void turn_rotations_scalar(std::span<const Spin> spin, float dt, std::span<Transform> transform);

/// position_i = center_i + amplitude_i sin(frequency_i time + phase_i).
void sway_positions(std::span<const Sway> sway, double time, std::span<Transform> transform);
void sway_positions_scalar(std::span<const Sway> sway, double time, std::span<Transform> transform);

/// Whether no step has been taken yet.
[[nodiscard]] inline bool is_unset(const PreviousWorldTransform& previous) {
    const Vec4& row = previous.world.row[0];
    return row.x == 0 && row.y == 0 && row.z == 0 && row.w == 0;
}

}  // namespace limn
