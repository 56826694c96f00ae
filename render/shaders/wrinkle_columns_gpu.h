// The columns of an image in which wrinkles are drawn by different methods (WrinkleComparison). Shared by C++ and GLSL;
// std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
#endif
#include "render/shaders/view_gpu.h"

#ifdef __cplusplus
namespace limn::layout {
#endif

struct WrinkleColumns {
    uint count;
    uint methods;  // kWrinkle*, four bits each, the first column's lowest
    float left;    // left and right end of the columns, 0 .. 1 of the width
    float right;
};

const uint kWrinkleColumnsBinding = kEffectBlocks + 2u;

#ifdef __cplusplus
static_assert(sizeof(WrinkleColumns) == 16);
}  // namespace limn::layout
#endif
