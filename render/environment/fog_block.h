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
// In-scattering: the mean radiance of the environment, and sunlight by the phase function of Henyey
// and Greenstein; other lights do not scatter, and shadows do not darken the fog.
// lib/height_fog.glsl is the same for shaders.

/// The fog for a camera at height `y` [m].
[[nodiscard]] layout::FogBlock
make_fog_block(const HeightFog& fog, const LightList& lights, float y);

}  // namespace limn
