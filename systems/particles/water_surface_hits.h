#pragma once

#include "ecs/base/math.h"
#include "systems/water/water_query.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

// Particles that fall into water, with all of its waves.

/// Water that particles hit.
struct ParticleWater {
    WaterSurface surface{};
    float highest = 0;        ///< upper bound of its surface in world space [m]
    float ripple = 0;         ///< ParticleCollider::ripple [m]
    float ripple_radius = 0;  ///< [m]
};

/// Upper bound of the height of the water above rest [m]: the sum of the maxima of all kinds of
/// waves.
[[nodiscard]] float highest_wave(const WaterSurface& surface);

struct WaterContact {
    std::uint32_t water = 0;  ///< index
    float fraction = 0;       ///< of the path, 0 .. 1
    Vec3 point = Vec3(0);     ///< on the surface, within 1 mm of height [m]
    Vec3 normal = Vec3(0);    ///< unit, up
};

/// Where the path from `from` to `to` first enters a body of water from above. None if it begins
/// below the surface. Waves whose crests are shorter than the path may be missed.
[[nodiscard]] std::optional<WaterContact>
enter_water(std::span<const ParticleWater> waters, const Vec3& from, const Vec3& to);

/// The ripple that a hit with this velocity [m/s] leaves, in the water's local space.
[[nodiscard]] RippleImpulse
make_ripple_impulse(const ParticleWater& water, const Vec3& point, const Vec3& velocity);

}  // namespace limn
