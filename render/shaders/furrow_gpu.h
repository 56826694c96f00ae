// Bindings of the passes that grow and visualize furrows. Shared by C++ and GLSL.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kFurrowVerticesUnit = 0u;
const uint kFurrowIndicesUnit = 1u;
const uint kFurrowMarksUnit = 0u;
const uint kFurrowHeightsUnit = 2u;
const uint kFurrowSceneUnit = 3u;
const uint kFurrowTrianglesBinding = 0u;
const uint kFurrowCoverBinding = 1u;
const uint kFurrowCellsBinding = 2u;
const uint kFurrowHeightsBinding = 3u;
const uint kFurrowProgressBinding = 4u;
const uint kFurrowHeightImage = 0u;
const uint kFurrowNormalImage = 1u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
