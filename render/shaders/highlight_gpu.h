// Data of a view for highlight maps (lib/highlight_map.glsl). Shared by C++ and GLSL; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
#endif
#include "render/shaders/view_gpu.h"

#ifdef __cplusplus
namespace limn::layout {
#endif

struct HighlightBlock {
    vec4 blinn_axis;  // world: fixes the axes of Blinn maps, unit or zero
};

const uint kHighlightBinding = kEffectBlocks + 1u;

// Bindings.
const uint kHighlightMapsUnit = 5u;
const uint kHighlightLayersUnit = 6u;
const uint kHighlightRecordsUnit = 7u;
const uint kHighlightMapsImage = 0u;

#ifdef __cplusplus
static_assert(sizeof(HighlightBlock) == 16);
}  // namespace limn::layout
#endif
