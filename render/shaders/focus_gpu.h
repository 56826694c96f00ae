// Depth of field: what its passes share. C++ and GLSL read the same text; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const int kFocusTaps = 48;
const int kSlightTaps = 37;     // of small circles: the pixels up to 3.2 px away
const int kFocusTile = 16;        // side [px]
const float kSharpest = 5.0f;     // diameter up to which circles are gathered from the picture itself [px]
const float kBlurriest = 6.0f;    // diameter from which they are gathered from its half [px]
const float kLeastCircle = 1.0f;  // diameter up to which a circle is no larger than its pixel [px]
const float kFineRadius = 8.0f;   // up to which the taps lie dense in the half picture [px]
const float kLevelRadius = 11.0f;  // up to which they lie dense enough for all but highlights [px]

struct FocusBlock {
    vec4 lens;      // circle of infinity focused at 1 m [px m]; 1 / focus; 1 / near plane [1/m]; largest circle [px]
    vec4 aperture;  // sides, 0: round; rotation [rad]; area and variance along an axis, of radius 1
    ivec4 tiles;    // columns; rows; tiles that the widest circle reaches; levels beneath the half picture
    vec4 size;      // of the picture [px]; of its half
    vec4 tap[48];   // xy: directions of a sunflower, to the rim of the aperture of radius 1; zw: the pixels around one,
                    // nearest first, of which kSlightTaps are used
    vec4 area[13];  // pixels that small circles cover, of radius i / 16 [px]
};

#ifdef __cplusplus
static_assert(sizeof(FocusBlock) == 1040);
}  // namespace limn::layout
#endif
