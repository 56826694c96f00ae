// Bindings of lookup tables of lobes (render/light/lobe_tables.h).

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const uint kLobeTablesUnit = 36u;
const uint kLobeLayersUnit = 37u;

#ifdef __cplusplus
}  // namespace limn::layout
#endif
