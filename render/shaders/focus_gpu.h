// Depth of field: what its passes share. C++ and GLSL read the same text; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const int kFocusTaps = 48;
const int kSlightTaps = 25;       // of small circles: the pixels less than 3 px away
const int kFineTaps = 69;         // of fine ones: the texels less than 4.6 texels away
const int kFocusTile = 16;        // side [px]
const int kFocusBlock = 4;        // side [px], of which tiles are made; small circles reach no further than one
const float kSharpest = 4.0f;     // diameter up to which circles are gathered from the picture itself [px]
const float kBlurriest = 5.0f;    // diameter from which they are gathered from its half [px]
const float kLeastCircle = 1.0f;  // diameter up to which a circle is no larger than its pixel [px]
const float kFineRadius = 8.0f;   // up to which every texel of the half picture is read [px]
const float kLevelRadius = 11.0f;  // up to which the taps lie dense enough for all but highlights [px]
const int kKernelStep = 8;        // kernels per pixel of radius
const int kKernels = 72;          // up to kFineRadius and a little
const int kSlightStep = 32;       // areas per pixel of radius
const int kAreas = 84;            // up to kBlurriest / 2 and a little

struct FocusBlock {
    vec4 lens;      // circle of infinity focused at 1 m [px m]; 1 / focus; 1 / near plane [1/m]; largest circle [px]
    vec4 aperture;  // sides, 0: round; rotation [rad]; area and variance along an axis, of radius 1
    ivec4 tiles;    // columns; rows; tiles that the widest circle reaches; levels beneath the half picture
    vec4 size;      // of the picture [px]; of its half
    vec4 tap[48];     // xy: directions of a sunflower, to the rim of the aperture of radius 1
    vec4 pixel[25];   // xy: the pixels around one, nearest first; z: how far away they are
    vec4 texel[69];   // xy: those of the half picture; z: radius of the aperture that goes through them, ascending
    vec4 kernel[36];  // xy, zw: for circles of radius i / kKernelStep [px], kernel [texels] and 1 / texels that it covers
    vec4 area[21];    // 1 / pixels that small circles cover, of radius i / kSlightStep [px]
};

#ifdef __cplusplus
static_assert(sizeof(FocusBlock) == 16 * (4 + 48 + 25 + 69 + 36 + 21));
}  // namespace limn::layout
#endif
