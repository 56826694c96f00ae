#pragma once

#include "ecs/components/transform.h"

#include <array>
#include <cstddef>
#include <span>

namespace limn {

// The inner loops of transform, spin and sway, each over one chunk of entities. Every kernel has a
// SIMD version for the machine's widest vectors (Highway, dispatched at run time) and a plain C++
// one, `_scalar`, which also handles the remainder. Both perform the same operations in the same
// order, without fused multiply-add and libm, so results are bit-identical on every machine.

/// Sine of any angle [rad]: range reduction in double precision, then the Cephes polynomials (S.
/// Moshier) in single precision; error at most 1e-7 for |angle| < 1e8.
[[nodiscard]] float sine(double angle);
[[nodiscard]] float cosine(double angle);

/// World matrices of entities without a parent: previous = world, then world = compose(local). If
/// an entity has no world matrix yet (previous is all 0), both get the new one.
void compose_worlds(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous);
void compose_worlds_scalar(
    std::span<const Transform> local, std::span<WorldTransform> world,
    std::span<PreviousWorldTransform> previous);

/// rotation = rotation * (rotation by speed * dt about axis), renormalized. No rotation if the axis
/// has length 0.
void turn_rotations(std::span<const Spin> spin, float dt, std::span<Transform> transform);
void turn_rotations_scalar(std::span<const Spin> spin, float dt, std::span<Transform> transform);

/// The fields of many Sways, an array per scalar.
struct SwayArrays {
    using Axes = std::array<std::span<const float>, 3>;
    Axes center;
    Axes amplitude;
    Axes frequency;
    Axes phase;

    [[nodiscard]] std::size_t size() const { return center[0].size(); }
    [[nodiscard]] SwayArrays subspan(std::size_t first, std::size_t count) const;
};

/// position_i = center_i + amplitude_i sin(frequency_i time + phase_i).
void sway_positions(const SwayArrays& sway, double time, std::span<Transform> transform);
void sway_positions_scalar(const SwayArrays& sway, double time, std::span<Transform> transform);

/// Whether no step has been computed yet.
[[nodiscard]] inline bool is_unset(const PreviousWorldTransform& previous) {
    const Vec4& row = previous.world.row[0];
    return row.x == 0 && row.y == 0 && row.z == 0 && row.w == 0;
}

}  // namespace limn
