#pragma once

#include "ecs/commands.h"
#include "ecs/components/ocean.h"
#include "ecs/components/time.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

// Waves of open water: height, slopes, horizontal displacement ("shift") and its derivatives by
// inverse Fourier transforms of each cascade's spectrum (water.fft-synthesis; J. Tessendorf,
// "Simulating Ocean Water", 2001), and foam where the displacement compresses the surface.
//
//     h(k, t) = h0(k) e^(-i omega t) + conj(h0(-k)) e^(i omega t)
//     height(q) = sum of h e^(i k.q),  shift(q) = choppiness * sum of i k / |k| h e^(i k.q)
//
// omega follows from k and the depth (water_dispersion.h). Waves neither interact nor break, and
// are not refracted by a shore. The shift is that of deep water; in shallow water, horizontal
// motion would be larger. The fields are a function of Ocean and time; only foam has state: the sum
// of all waves breaks, as it is about the origin.

/// Adds OceanState and OceanFoam to each Ocean that lacks them.
void add_ocean_states(
    Query<const Ocean, Without<OceanState>> stateless,
    Query<const Ocean, Without<OceanFoam>> foamless, Commands commands);

/// Evaluates the waves at the end of this step. Regenerates the spectra if an Ocean has changed; an
/// Ocean out of range is clamped, with a warning in the log.
void update_oceans(Query<const Ocean, OceanState> oceans, Res<const FrameTime> time);

/// Grows and decays foam. After update_oceans.
void update_ocean_foam(
    Query<const Ocean, const OceanState, OceanFoam> oceans, Res<const FrameTime> time);

/// Evaluates the fields at `time`, and the previous ones at `time` - `step`.
void step_ocean(const Ocean& ocean, double time, float step, OceanState& state);

/// Writes the fields of one cascade at `time`, except the previous ones.
void synthesize_waves(OceanCascade& cascade, float choppiness, double time);

/// Advances foam by `step` [s].
void step_ocean_foam(const Ocean& ocean, const OceanState& state, float step, OceanFoam& foam);

}  // namespace limn
