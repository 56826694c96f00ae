#pragma once

#include "ecs/components/water.h"
#include "ecs/components/water_detail.h"
#include "ecs/components/water_waves.h"
#include "systems/water/water_wave_kernels.h"

#include <vector>

namespace limn {

// Creation and evaluation of a WaveTable.

/// Random waves of a group; deterministic.
[[nodiscard]] std::vector<WaterWave> generate_waves(const WaveGroup& group);

/// Table of all waves of `waves` at `time` [s]. Wave speeds follow from depth and gravity
/// (water_dispersion.h). If crests would fold over, sum Q A k > 1, all sharpnesses are reduced.
/// Waves without length or with numbers that are not finite are skipped. Reuses the table's memory.
void fill_wave_table(const Water& water, const WaterWaves& waves, double time, WaveTable& table);

/// Slightly rotates and stretches the waves that are rendered into a texture (WaterDetail::split),
/// so that a whole number of each fits its tile. Their frequencies are unchanged.
void snap_waves(const WaterDetail& detail, WaveTable& table);

/// Sum of all waves with lengths >= `shortest` [m] at (x, z) in the water's local space.
[[nodiscard]] WavePoint evaluate_waves(const WaveTable& table, const Vec2& at, float shortest = 0);

}  // namespace limn
