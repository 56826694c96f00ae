// Block of materials with the shading model Subsurface.
//
// Light that enters at a point exits around it by the normalized profile of Christensen and Burley, "Approximate
// Reflectance Profiles for Efficient Subsurface Scattering", 2015:
//
//     R(r) = (exp(-r/d) + exp(-r/3d)) / (8 pi d r),    fraction within r: 1 - exp(-r/d)/4 - 3 exp(-r/3d)/4
//
// The diffusion pass sums it over rings, each sampled at one point; fewer rings if they cover few pixels.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kDiffusionSamples = 80u;
const uint kFewDiffusionSamples = 36u;
const uint kFewestDiffusionSamples = 20u;

struct SubsurfaceBlock {
    vec4 specular;  // reflectance at normal incidence; w: weight of the second lobe
    vec4 diffusion;  // d for red, green and blue [m]; w: perceptual roughness of the second lobe
    vec4 samples[kDiffusionSamples];  // x: radius [m], increasing; yzw: weight for red, green and blue
    vec4 few_samples[kFewDiffusionSamples];  // the same for surfaces far away
    vec4 fewest_samples[kFewestDiffusionSamples];  // and even farther away
};

const int kDiffusionTexel = 1;
const int kSamplesTexel = 2;
const int kFewSamplesTexel = kSamplesTexel + int(kDiffusionSamples);
const int kFewestSamplesTexel = kFewSamplesTexel + int(kFewDiffusionSamples);

// Bindings.
const uint kScatteredUnit = 0u;
const uint kDistancesUnit = 1u;
const uint kDistanceMomentsImage = 0u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
