#pragma once

#include "systems/particles/collider.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// Broad phase: which of many particles come near a collider in a step. The test is conservative: it
// never rejects one that would touch. Most particles touch nothing, and eight or sixteen are tested
// at once (Highway, dispatched at run time).

/// The bounds of a collider, in the form that is quickest to test.
struct ColliderBounds {
    enum class Kind : std::uint8_t {
        Plane,   ///< dot(normal, x) < offset
        Hollow,  ///< beyond `radius` of a center
        Box,
        Field,  ///< a height field, within its box
    };
    Kind kind = Kind::Box;
    Vec3 normal = Vec3(0);
    float offset = 0;
    Vec3 center = Vec3(0);
    float radius = 0;
    Bounds box{};
    HeightCollider field{};
    Vec2 slope = Vec2(0);  ///< of the field, largest along x and z
    float stretch = 1;     ///< maximum distance of a ball that touches, in radii
};

[[nodiscard]] ColliderBounds find_collider_bounds(const Collider& collider);

/// The paths of particles in a step, an array per scalar, all of the same size.
struct ParticlePaths {
    std::span<const float> x0{}, y0{}, z0{};
    std::span<const float> x1{}, y1{}, z1{};
    std::span<const float> radius{};  ///< [m]; empty: `one_radius` for all
    float one_radius = 0;
    float skin = 0;  ///< as in CollisionOptions
};

/// Distance that a particle keeps from surfaces: at least several units in the last place of its
/// coordinates, or rounding would swallow it.
[[nodiscard]] float skin_of(const Vec3& from, const Vec3& to, float skin);

/// Whether a particle may touch, or be inside. True if a coordinate is not finite.
[[nodiscard]] bool
may_touch(const ColliderBounds& bounds, const Vec3& from, const Vec3& to, float radius, float skin);

/// Writes the indices of those of [first, first + count) that may_touch one of `bounds`, ascending,
/// to `found`, which has room for count + kCandidatePadding; returns how many.
inline constexpr std::size_t kCandidatePadding = 64;
std::size_t find_near(
    const ParticlePaths& paths, std::size_t first, std::size_t count,
    std::span<const ColliderBounds> bounds, std::uint32_t* found);
std::size_t find_near_scalar(
    const ParticlePaths& paths, std::size_t first, std::size_t count,
    std::span<const ColliderBounds> bounds, std::uint32_t* found);

}  // namespace limn
