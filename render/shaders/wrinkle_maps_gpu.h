// Bindings of wrinkle_maps.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// Consecutive, as WrinkleMapsEffect binds them.
const uint kWrinkleBaseUnit = 0u;
const uint kWrinkleStretchedUnit = 1u;
const uint kWrinkleCompressedUnit = 2u;
const uint kWrinkleFirstMasksUnit = 3u;
const uint kWrinkleSecondMasksUnit = 4u;
const uint kWrinkleThirdMasksUnit = 5u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
