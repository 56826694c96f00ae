// A coat of fur (lib/fur.glsl), read from a texture buffer as kFurTexels RGBA32F texels, by the number in the flags of
// an instance.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct FurRecord {
    vec4 lean;     // of tips, in mesh space and in lengths; w: toward the ground
    vec4 strands;  // length [m], strands along a unit of u and of v, set of texture coordinates
    vec4 shape;    // radius of roots, length of the shortest strand, wave, unruliness
    vec4 color;    // factor of the color of tips; w: of roots
    vec4 noise;    // x: variation of brightness
};

const uint kFurTexels = 5u;
const uint kMaxFurs = 127u;
const uint kFurShift = 1u;  // first bit of the number in InstanceRecord::flags
const uint kFurMask = 127u;

// Bindings.
const uint kFursUnit = 34u;

#ifdef __cplusplus
static_assert(sizeof(FurRecord) == 16 * kFurTexels);
}  // namespace limn::layout
#endif
