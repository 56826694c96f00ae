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
    vec4 ray_right;            // added to the view ray per unit of NDC x, in world space; w: jitter, NDC x
    vec4 ray_up;               // the same for y; w: jitter, NDC y
    vec4 ray_forward;          // unit; w: 1 = shading assumes an infinitely distant viewer
    vec4 size;                 // width, height [px], 1 / width, 1 / height
    vec4 grid_cells;           // columns, rows, slices of the light clusters; w: side of a tile [px]
    vec4 grid_depth;           // slice = x log2(distance) + y; z: number of directional lights; w: first point or
                               // spot light with a shadow or a cookie
    vec4 clip_plane;           // world: CLIPPED surfaces are drawn where dot(xyz, p) + w >= 0
    vec4 orthographic;         // x: distance of the eye behind an orthographic camera, where fog and cascades begin [m]
    vec4 tessellation;         // eye for which displaced meshes are divided, also in its shadow maps; w: pixels per meter
                               // at a distance of 1 m
};

const uint kViewBinding = 0u;

// Blocks that effects publish for a view (ViewData::publish_block). Each has its own number, kEffectBlocks + n, stated
// in its effect's header; in a view for which it is not published, it is all zeros.
const uint kEffectBlocks = 8u;
const uint kMaxEffectBlocks = 4u;
const uint kEffectBlockBytes = 256u;  // of each, at most

#ifdef __cplusplus
static_assert(sizeof(ViewBlock) == 288);
}  // namespace limn::layout
#endif
