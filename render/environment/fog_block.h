#pragma once

#include "ecs/components/height_fog.h"
#include "render/shaders/fog_gpu.h"

namespace limn {

struct LightList;

// Exponential height fog in closed form (Quílez, "Better fog", 2010): along a ray that rises by s a
// meter, from where the extinction is e, the optical depth of t meters is
//
//     e (1 - exp(-x)) / x t,   x = s t / scale height
//
// What the fog takes away it scatters: the mean radiance from all around, and the sun's light by
// Henyey and Greenstein's phase function; not that of other lights, and shadows do not darken it.
// lib/height_fog.glsl is the same for shaders.

/// As a camera at the height `y` [m] meets it.
[[nodiscard]] layout::FogBlock
make_fog_block(const HeightFog& fog, const LightList& lights, float y);

}  // namespace limn
