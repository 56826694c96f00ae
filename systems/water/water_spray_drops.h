#pragma once

#include "ecs/base/rng.h"
#include "ecs/components/water_spray.h"
#include "systems/water/water_query.h"

#include <vector>

namespace limn {

// Where water sprays (water.crest-spray, water.impact-spray): of the lines of a WaveTable, whose
// crests are known. At a crest water moves with Q = pi H C / L along the wave, H its height, L its
// length, C its speed; it would overtake the wave at H / L = 1 / pi, the steepness of cusps, but
// waves break from 0.1 on (Peachey 1986).

/// Q [m/s].
[[nodiscard]] float orbital_speed(float height, float length, float speed);
/// Of a line.
[[nodiscard]] float orbital_speed(const WaveLine& line);
/// H / L.
[[nodiscard]] float steepness(const WaveLine& line);

/// Adds the drops that fly in a step from crests of waves steeper than `source` says: from random
/// places within 5 % of the crest's height, at about Q along the wave.
void spray_crests(
    const WaterSurface& surface, const SpraySource& source, float step, Random& random,
    std::vector<SprayDrop>& drops);

/// Share of the most spray while the wave is `phase` [rad] away from its crest: cos^4, 0 from a
/// quarter of a wave on.
[[nodiscard]] float impact_share(float phase);

/// Adds the drops that fly in a step from where the strongest wave hits a wall at `point`: at about
/// Q, in a cone about the way that it would be thrown back. `normal` is unit.
void spray_impact(
    const WaterSurface& surface, const SprayObstacle& obstacle, const Vec3& point,
    const Vec3& normal, float step, Random& random, std::vector<SprayDrop>& drops);

}  // namespace limn
