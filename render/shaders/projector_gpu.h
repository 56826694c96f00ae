// A cookie (projected image) of a light, read from a texture buffer as kProjectorTexels RGBA32F texels.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ProjectorRecord {
    vec4 row_s;   // image_from_world: dot with (position, 1) gives u times q, 0 .. 1 over a frame,
    vec4 row_t;   // v times q, from the top
    vec4 row_q;   // and q, which is > 0 in front of the light
    vec4 frame;   // left, top, width and height of the frame in the image
    vec4 source;  // layer of the images, side of a layer [texels]
};

const uint kProjectorTexels = 5u;

// Bindings.
const uint kProjectorImagesUnit = 18u;
const uint kProjectorsUnit = 19u;

#ifdef __cplusplus
static_assert(sizeof(ProjectorRecord) == 16 * kProjectorTexels);
}  // namespace limn::layout
#endif
