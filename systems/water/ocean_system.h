#pragma once

#include "ecs/commands.h"
#include "ecs/components/ocean.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Waves of open water: from the spectrum of each cascade to height, slopes, shift and its
// derivatives by inverse Fourier transforms (water.fft-synthesis; J. Tessendorf, "Simulating Ocean
// Water", 2001), and foam where the shift squeezes the water together.
//
//     h(k, t) = h0(k) e^(-i omega t) + conj(h0(-k)) e^(i omega t)
//     height(q) = sum of h e^(i k.q),  shift(q) = choppiness * sum of i k / |k| h e^(i k.q)
//
// omega follows from k and the depth (water_dispersion.h). Waves neither feel each other nor break,
// and a shore does not turn them. The shift is that of deep water: over a shallow floor water moves
// farther to and fro than it does here. The fields are a function of the Ocean and the time; foam
// alone has a history, and in each cascade knows only the waves of that cascade.

/// Gives each Ocean its OceanState and OceanFoam.
void add_ocean_states(
    Query<const Ocean, Without<OceanState>> stateless,
    Query<const Ocean, Without<OceanFoam>> foamless, Commands commands);

/// Moves the waves to the end of this step. Draws the spectra anew where an Ocean has changed; an
/// Ocean beyond its limits is brought within, with a line in the log.
void update_oceans(Query<const Ocean, OceanState> oceans, Res<const FrameTime> time);

/// After update_oceans.
void update_ocean_foam(
    Query<const Ocean, const OceanState, OceanFoam> oceans, Res<const FrameTime> time);

/// Brings the fields to `time`, and the last ones to `step` before it.
void step_ocean(const Ocean& ocean, double time, float step, OceanState& state);

/// Writes the fields of one cascade at `time`; not the last ones.
void synthesize_waves(OceanCascade& cascade, float choppiness, double time);

/// Lets foam grow and fade for `step` [s].
void step_ocean_foam(const Ocean& ocean, const OceanState& state, float step, OceanFoam& foam);

}  // namespace limn
