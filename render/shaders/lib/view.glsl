// From pixels to the world and back.
// Techniques: light.infinite-approx, post.linear-to-window-depth

#include "view_gpu.h"

#ifndef OPAQUE_UNIFORMS
layout(std140, binding = kViewBinding) uniform View {
    ViewBlock view;
};
// A uniform block of one struct, for conditions and loops: of `Type`, read as `name`. `names` is for the workaround below.
#define UNIFORM_BLOCK(number, Block, Type, name, names) layout(std140, binding = number) uniform Block { Type name; }
#else
// Driver workaround (DeviceCaps::opaque_uniforms): the same block, read at an index that is 0 only at run time.
layout(std140, binding = kViewBinding) uniform View {
    ViewBlock view_blocks[1];
};
ViewBlock view = view_blocks[min(int(view_blocks[0].size.x), 0)];
#define UNIFORM_BLOCK(number, Block, Type, name, names)                    \
    layout(std140, binding = number) uniform Block { Type names[1]; }; \
    Type name = names[min(int(view.size.x), 0)]
#endif

// Ray through a pixel (gl_FragCoord.xy), of length 1 m along the view axis.
vec3 view_ray(vec2 pixel) {
    vec2 ndc = pixel * view.size.zw * 2.0 - 1.0 - vec2(view.ray_right.w, view.ray_up.w);
    return view.ray_forward.xyz + ndc.x * view.ray_right.xyz + ndc.y * view.ray_up.xyz;
}

// Distance along the view axis [m] of a depth > 0: depth is reversed, the far plane infinite.
float view_distance(float depth) {
    return view.camera_ws.w / depth;
}

vec3 world_position(vec2 pixel, float depth) {
    return view.camera_ws.xyz + view_ray(pixel) * view_distance(depth);
}

// Unit direction from a surface to the camera; constant for an infinitely distant viewer (light.infinite-approx).
vec3 to_viewer(vec3 position_ws) {
    return view.ray_forward.w > 0.5 ? -view.ray_forward.xyz : normalize(view.camera_ws.xyz - position_ws);
}
