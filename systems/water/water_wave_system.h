#pragma once

#include "ecs/commands.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_detail.h"
#include "ecs/components/water_waves.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

/// Adds a WaveTable to every Water with WaterWaves that lacks one. Before fill_wave_tables, with a
/// sync point in between.
void add_wave_tables(
    Query<const Water, const WaterWaves, Without<WaveTable>> bare, Commands commands);

/// Ages wave packets and removes expired ones.
void age_wave_packets(Query<WaterWaves> waters, Res<const FrameTime> time);

/// Fills the tables for the time at the end of the step.
void fill_wave_tables(
    Query<const Water, const WaterWaves, WaveTable, Optional<const WaterDetail>> waters,
    Res<const FrameTime> time);

}  // namespace limn
