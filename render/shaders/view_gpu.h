// The camera, for every pass. Shared by C++ and GLSL; std140.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

struct ViewBlock {
    mat4 clip_from_world;      // with the jitter
    mat4 previous_clip_from_world;  // previous frame's clip_from_world, without the jitter
    vec4 camera_ws;            // w: near plane [m]
    vec4 ray_right;            // world direction by which one unit of NDC x turns the view ray; w: jitter, NDC x
    vec4 ray_up;               // the same for y; w: jitter, NDC y
    vec4 ray_forward;          // unit; w: 1 = shading assumes an infinitely distant viewer
    vec4 size;                 // width, height [px], 1 / width, 1 / height
    vec4 grid_cells;           // columns, rows, slices of the light clusters; w: side of a tile [px]
    vec4 grid_depth;           // slice = x log2(distance) + y; z: number of directional lights; w: first point or
                               // spot light with a shadow or a cookie
    vec4 clip_plane;           // world: CLIPPED surfaces are drawn where dot(xyz, p) + w >= 0
    vec4 blinn_axis;           // world: fixes the axes of Blinn maps, unit or zero (lib/highlight_map.glsl)
    uvec4 wrinkle_columns;     // x: columns with wrinkles by different methods; y: those, four bits each, the first lowest;
                               // z, w: floats, where they begin and end, 0 .. 1 of the width
    vec4 fog;                  // extinction at the camera [1/m], 0: none; 1 / its scale height; forward scattering; w:
                               // how far the eye is behind an orthographic camera [m], where fog and shadow cascades begin
    vec4 fog_ambient;          // radiance that it scatters from all around
    vec4 fog_sun;              // irradiance of the sun that it scatters
    vec4 fog_to_sun;           // world, unit
};

#ifdef __cplusplus
static_assert(sizeof(ViewBlock) == 352);
}  // namespace limn::layout
#endif
