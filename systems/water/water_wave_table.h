#pragma once

#include "ecs/components/water.h"
#include "ecs/components/water_detail.h"
#include "ecs/components/water_waves.h"

#include <vector>

namespace limn {

// What the waves of a WaveTable do to the water.

/// What waves do to the water at rest at one point.
struct WavePoint {
    Vec3 offset = {0, 0, 0};    ///< [m]
    Vec3 by_x = {0, 0, 0};      ///< of the offset, d / dx
    Vec3 by_z = {0, 0, 0};      ///< d / dz
    Vec3 velocity = {0, 0, 0};  ///< d / dt [m/s]

    WavePoint& operator+=(const WavePoint& other);
};

/// The waves that a group draws; the same for the same group.
[[nodiscard]] std::vector<WaterWave> draw_waves(const WaveGroup& group);

/// The table at `time` [s] of all that `waves` has. Depth and gravity say how fast they run
/// (water_dispersion.h). Where all together would fold crests over, sum Q A k > 1, all are blunter.
/// Waves without length, or with numbers that are not finite, are left out. Keeps the table's
/// memory.
void fill_wave_table(const Water& water, const WaterWaves& waves, double time, WaveTable& table);

/// Turns and stretches the waves that are drawn into a texture (WaterDetail::split) a little, so
/// that all fit into its tile a whole number of times. They run as fast as before.
void snap_waves(const WaterDetail& detail, WaveTable& table);

/// Of all waves of at least the length `shortest` [m] at (x, z) in the water's own space.
[[nodiscard]] WavePoint evaluate_waves(const WaveTable& table, const Vec2& at, float shortest = 0);

}  // namespace limn
