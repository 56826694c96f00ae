// Bindings of temporal.frag, in addition to fullscreen_gpu.h. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kHistoryUnit = 1u;
const uint kTemporalVelocityUnit = 2u;
const uint kTemporalDepthUnit = 3u;
const uint kMomentsUnit = 4u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
