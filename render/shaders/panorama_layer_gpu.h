// Bindings of panorama_layer.frag. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kPanoramaLayerUnit = 0u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
