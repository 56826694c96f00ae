// The camera, as every pass sees it. C++ and GLSL read the same text; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ViewBlock {
    mat4 clip_from_world;      // with the jitter
    mat4 previous_from_world;  // without the jitter, of the moment before
    vec4 camera_ws;            // w: near plane [m]
    vec4 ray_right;            // world direction by which one unit of NDC x turns the view ray; w: jitter, NDC x
    vec4 ray_up;               // the same for y; w: jitter, NDC y
    vec4 ray_forward;          // unit; w: 1 where shading takes the viewer to be infinitely far away
    vec4 size;                 // width, height [px], 1 / width, 1 / height
    vec4 grid_cells;           // columns, rows, slices of the light clusters; w: side of a tile [px]
    vec4 grid_depth;           // slice = x log2(distance) + y; z: number of directional lights; w: first light
                               // with a shadow or an image that is not directional
    vec4 clip_plane;           // world: CLIPPED surfaces are drawn where dot(xyz, p) + w >= 0
};

#ifdef __cplusplus
static_assert(sizeof(ViewBlock) == 256);
}  // namespace limn::layout
#endif
