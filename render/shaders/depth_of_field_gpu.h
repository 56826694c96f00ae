// Depth of field: layout of its passes, shared by C++ and GLSL; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

const int kFocusTaps = 48;
const int kSlightTaps = 25;       // for small circles: the pixels less than 3 px away
const int kFineTaps = 69;         // for fine circles: the half-resolution texels less than 4.6 texels away
const int kFocusTile = 16;        // side [px]
const int kFocusBlock = 4;        // side of the blocks in a tile [px]; small circles extend into adjacent blocks only
const float kFullResDiameter = 4.0f;  // up to which circles are gathered at full resolution [px]
const float kHalfResDiameter = 5.0f;  // from which they are gathered at half resolution [px]
const float kMinCircle = 1.0f;  // diameter up to which a circle is no larger than its pixel [px]
const float kFineRadius = 8.0f;   // up to which every half-resolution texel is read [px]
const float kLevelRadius = 11.0f;  // up to which the taps are dense enough, except for highlights [px]
const int kKernelStep = 8;        // kernels per pixel of radius
const int kKernels = 72;          // slightly beyond kFineRadius
const int kSlightStep = 32;       // areas per pixel of radius
const int kAreas = 84;            // slightly beyond kHalfResDiameter / 2

struct FocusBlock {
    vec4 lens;      // circle of infinity focused at 1 m [px m]; 1 / focus; 1 / near plane [1/m]; largest circle [px]
    vec4 aperture;  // sides, 0: round; rotation [rad]; area and variance along an axis, for radius 1
    ivec4 tiles;    // columns; rows; radius of the widest circle [tiles]; mip levels below half resolution
    vec4 size;      // of the image [px]; of the half-resolution image [px]
    vec4 tap[48];     // xy: directions of a sunflower pattern, to the rim of the aperture of radius 1
    vec4 pixel[25];   // xy: offsets of the neighboring pixels, nearest first; z: their distances
    vec4 texel[69];   // xy: the same at half resolution; z: radius of the aperture with its rim through it, ascending
    vec4 kernel[36];  // xy, zw: for circles of radius i / kKernelStep [px], radius [texels] and 1 / texels covered
    vec4 area[21];    // 1 / pixels covered by small circles of radius i / kSlightStep [px]
};

// Bindings.
const uint kFocusBinding = 2u;
const uint kFocusRadianceUnit = 0u;
const uint kFocusDepthUnit = 1u;
const uint kFocusBlocksUnit = 2u;
const uint kFocusSmallBlocksUnit = 3u;
const uint kFocusOwnTilesUnit = 4u;
const uint kFocusOwnSmallUnit = 5u;
const uint kFocusPackedUnit = 6u;
const uint kFocusTilesUnit = 7u;
const uint kFocusSlightTilesUnit = 8u;
const uint kFocusNearLightUnit = 9u;
const uint kFocusNearWideUnit = 10u;
const uint kFocusBehindNearUnit = 11u;
const uint kFocusFarLightUnit = 12u;
const uint kFocusFarKernelsUnit = 13u;
const uint kFocusNearKernelsUnit = 14u;
const uint kFocusFarWideUnit = 15u;
const uint kFocusWideRadiiUnit = 16u;
const uint kFocusLuminanceUnit = 17u;
const uint kFocusFarBaseUnit = 18u;
const uint kFocusNearBaseUnit = 19u;
const uint kFocusBaseRadiiUnit = 20u;
const uint kFocusFarCoarseUnit = 21u;
const uint kFocusNearCoarseUnit = 22u;
const uint kFocusNearRadiusUnit = 23u;
const uint kFocusFarBlurredUnit = 24u;
const uint kFocusNearBlurredUnit = 25u;
const uint kFocusSmallNearUnit = 26u;

#ifdef __cplusplus
static_assert(sizeof(FocusBlock) == 16 * (4 + 48 + 25 + 69 + 36 + 21));
}  // namespace limn::layout
#endif
