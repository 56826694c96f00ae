// Cookies: images projected by lights (shadow.projector).
// Techniques: shadow.projector

#include "lib/view.glsl"
#include "projector_gpu.h"

layout(binding = kProjectorImagesUnit) uniform sampler2DArray projector_images;  // linear, with mip levels
layout(binding = kProjectorsUnit) uniform samplerBuffer projectors;              // ProjectorRecord

// Color filter of cookie `number` (from 1; 0 is none) for light at `position_ws`.
vec3 projected_color(float number, vec3 position_ws) {
    int at = max(int(number) - 1, 0) * int(kProjectorTexels);
    vec4 row_s = texelFetch(projectors, at);
    vec4 row_t = texelFetch(projectors, at + 1);
    vec4 row_q = texelFetch(projectors, at + 2);
    vec4 frame = texelFetch(projectors, at + 3);
    vec4 source = texelFetch(projectors, at + 4);
    vec4 position = vec4(position_ws, 1.0);
    float q = dot(row_q, position);
    vec2 uv = vec2(dot(row_s, position), dot(row_t, position)) / q;
    bool inside = q > 0.0 && all(greaterThanEqual(uv, vec2(0.0))) && all(lessThanEqual(uv, vec2(1.0)));

    // Mip level from the texels that a pixel covers here; screen derivatives would break at the frame's edges.
    float along = dot(position_ws - view.camera_ws.xyz, view.ray_forward.xyz);
    float pixel = 2.0 * view.size.w * length(view.ray_up.xyz) * along;
    float speed = max(length(row_s.xyz - uv.x * row_q.xyz) * frame.z, length(row_t.xyz - uv.y * row_q.xyz) * frame.w);
    float level = log2(max(speed / max(abs(q), 1e-6) * pixel * source.y, 1e-6));
    vec2 half_texel = vec2(0.5 / source.y);
    vec2 st = clamp(frame.xy + uv * frame.zw, frame.xy + half_texel, frame.xy + frame.zw - half_texel);
    vec3 color = textureLod(projector_images, vec3(st, source.x), level).rgb;
    return number < 0.5 ? vec3(1.0) : inside ? color : vec3(0.0);
}
