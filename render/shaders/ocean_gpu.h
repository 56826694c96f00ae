// Bindings of the passes that evaluate the ocean (ocean_fft.h). Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kOceanWavesBinding = 0u;
const uint kOceanFrequenciesBinding = 1u;
const uint kOceanLinesBinding = 2u;
const uint kOceanDisplacementImage = 0u;
const uint kOceanDerivativesImage = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
