#pragma once

#include "systems/particles/collider.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace limn {

// Which of many particles come near a collider in a step. The test is conservative: it never
// rejects one that would touch. Most particles touch nothing, and eight or sixteen are tested at
// once (Highway, dispatched at run time).

/// What a collider reaches, in the form that is quickest to test.
struct ColliderReach {
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
    float stretch = 1;     ///< how many radii away a ball may touch
};

[[nodiscard]] ColliderReach find_reach(const Collider& collider);

/// The ways of particles, an array per scalar, all of the same size.
struct ParticleWays {
    std::span<const float> x0{}, y0{}, z0{};
    std::span<const float> x1{}, y1{}, z1{};
    std::span<const float> radius{};  ///< [m]; empty: `one_radius` for all
    float one_radius = 0;
    float skin = 0;  ///< as in CollisionOptions
};

/// Distance from surfaces that a particle keeps: several units in the last place of where it goes,
/// or the skin would round away.
[[nodiscard]] float skin_of(const Vec3& from, const Vec3& to, float skin);

/// Whether a particle may touch, or be inside. True if a coordinate is not finite.
[[nodiscard]] bool
may_touch(const ColliderReach& reach, const Vec3& from, const Vec3& to, float radius, float skin);

/// Writes the numbers of those of [first, first + count) that may_touch one of `reach`, ascending,
/// to `found`, which has room for count + kReachRoom; returns how many.
inline constexpr std::size_t kReachRoom = 64;
std::size_t find_near(
    const ParticleWays& ways, std::size_t first, std::size_t count,
    std::span<const ColliderReach> reach, std::uint32_t* found);
std::size_t find_near_scalar(
    const ParticleWays& ways, std::size_t first, std::size_t count,
    std::span<const ColliderReach> reach, std::uint32_t* found);

}  // namespace limn
