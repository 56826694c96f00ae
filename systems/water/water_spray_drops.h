#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/water_spray.h"
#include "systems/water/water_query.h"

#include <vector>

namespace limn {

// Spray emission (water.crest-spray, water.impact-spray), from the straight-crested waves of a
// WaveTable, whose crest positions are known, and from any other water by its velocity. At a crest,
// water moves along the wave with the speed Q = pi H C / L, where H is the height, L the length and
// C the speed of the wave. It would overtake the wave at H / L = 1 / pi, the steepness of cusps,
// but waves break from 0.1 on (Peachey 1986).

/// Orbital speed Q [m/s].
[[nodiscard]] float orbital_speed(float height, float length, float speed);
/// The same for a wave line.
[[nodiscard]] float orbital_speed(const WaveLine& line);
/// H / L of a wave line.
[[nodiscard]] float steepness(const WaveLine& line);

/// Adds the drops emitted in a step from crests of waves steeper than `source.steepness`: at random
/// positions within 5 % of the crest's height, with about the speed Q along the wave.
void spray_crests(
    const WaterSurface& surface, const SpraySource& source, float step, Random& random,
    std::vector<SprayDrop>& drops);

/// The same for an Ocean, whose crests are not known: points of the window, at random, shed a drop
/// with the chance `foam_threshold` - J, so where foam forms (J is the Jacobian determinant of the
/// displacement). It starts with about the water's velocity. `source.rate` is that of 100 m^2 with
/// the chance 1.
void spray_breakers(
    const WaterSurface& surface, const SpraySource& source, float step, Random& random,
    std::vector<SprayDrop>& drops);

/// Emission relative to its maximum at the phase offset `phase` [rad] from the crest: cos^4, 0
/// beyond a quarter wave.
[[nodiscard]] float impact_share(float phase);

/// Adds the drops emitted in a step where the strongest wave hits a wall at `point`: with about the
/// speed Q, in a cone about the reflected direction. `normal` is unit. On water without closed-form
/// waves, or where none of them runs against the wall: by the speed of its surge.
void spray_impact(
    const WaterSurface& surface, const SprayObstacle& obstacle, const Vec3& point,
    const Vec3& normal, float step, Random& random, std::vector<SprayDrop>& drops);

/// The orbital speed in the crests of any water: sqrt(2) times the root mean square of its
/// horizontal speed at points about `around`, in world space [m/s].
[[nodiscard]] float surge_speed(const WaterSurface& surface, const Vec2& around);

/// Emission relative to its maximum, of water that runs against a wall at `speed` [m/s]: as
/// impact_share, since in a wave that is the cosine of the phase times `crest_speed`. Slower than
/// kMinSurge, water does not spray.
[[nodiscard]] float surge_share(float speed, float crest_speed);
inline constexpr float kMinSurge = 1.0f;  ///< [m/s], by eye

/// A convex body that water hits.
struct SprayBody {
    bool is_box = false;  ///< or an ellipsoid
    Vec3 half = {0.5f, 0.5f, 0.5f};
    Affine world{};   ///< of its center, at the end of the step
    Affine before{};  ///< at the beginning
};

/// Adds the drops emitted in a step along the waterline of a body that is about upright, where
/// water and body run into each other: with about the speed at which they meet, in a cone about the
/// direction of water thrown back and up. `crest_speed` is surge_speed.
void spray_body(
    const WaterSurface& surface, const SprayObstacle& obstacle, const SprayBody& body,
    float crest_speed, float step, Random& random, std::vector<SprayDrop>& drops);

}  // namespace limn
