// One attribute of the G-buffer as plain numbers, for files and the buffer viewer.
//   AOV  0 depth, 1 normal, 2 albedo, 3 velocity, 4 emission, 5 texels of shadow maps: the order of aov_names()
// Techniques: shadow.map-aliasing
#version 450
#include "lib/gbuffer.glsl"
#include "lib/view.glsl"
#include "gbuffer_gpu.h"

layout(binding = kGbufferUnit) uniform usampler2D gbuffer;
layout(binding = kDepthUnit) uniform sampler2D scene_depth;
#if AOV == 3
layout(binding = kVelocityUnit) uniform sampler2D scene_velocity;
#endif

#if AOV == 5
#include "shadow_gpu.h"
layout(binding = kShadowViewsUnit) uniform samplerBuffer shadow_views;  // ShadowViewRecord
uniform int shadow_view_count;
#endif

layout(location = 0) out vec4 value;

#if AOV == 5
// Area [texels] that a pixel covers in a view's shadow map, for a surface at the end of `ray`; 0 outside the map. The
// same as texels_per_pixel() (render/shadow/shadow_view.h).
float texels_under_pixel(int view_index, vec3 ray, vec3 normal, vec3 right, vec3 up) {
    int at = view_index * int(kShadowViewTexels);
    vec4 position = vec4(view.camera_ws.xyz + ray, 1.0);
    vec4 row_s = texelFetch(shadow_views, at);
    vec4 row_t = texelFetch(shadow_views, at + 1);
    vec4 row_q = texelFetch(shadow_views, at + 3);
    vec4 rect = texelFetch(shadow_views, at + 7);
    float q = dot(row_q, position);
    vec2 st = vec2(dot(row_s, position), dot(row_t, position)) / q;
    vec3 speed_s = row_s.xyz - st.x * row_q.xyz;
    vec3 speed_t = row_t.xyz - st.y * row_q.xyz;
    vec3 along_x = right - ray * (dot(normal, right) / dot(normal, ray));
    vec3 along_y = up - ray * (dot(normal, up) / dot(normal, ray));
    float area = dot(speed_s, along_x) * dot(speed_t, along_y) - dot(speed_t, along_x) * dot(speed_s, along_y);
    bool inside = q > 0.0 && all(greaterThan(st, rect.xy)) && all(lessThan(st, rect.zw));
    return inside ? abs(area) / (q * q) : 0.0;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(scene_depth, pixel, 0).r;
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
#if AOV == 0
    value = vec4(view_distance(depth), 0.0, 0.0, 1.0);
#elif AOV == 1
    value = vec4(s.normal_ws, 1.0);
#elif AOV == 2
    value = vec4(s.albedo, 1.0);
#elif AOV == 3
    value = vec4(texelFetch(scene_velocity, pixel, 0).rg * vec2(view.size.x, -view.size.y), 0.0, 1.0);
#elif AOV == 5
    float distance = view_distance(depth);
    vec3 ray = view_ray(gl_FragCoord.xy) * distance;
    vec3 right = view.ray_right.xyz * (2.0 * view.size.z * distance);
    vec3 up = view.ray_up.xyz * (2.0 * view.size.w * distance);
    float finest = 0.0;
    for (int n = 0; n < shadow_view_count; ++n) {
        finest = max(finest, texels_under_pixel(n, ray, s.normal_ws, right, up));
    }
    value = vec4(finest, 0.0, 0.0, 1.0);
#else
    value = vec4(s.emission, 1.0);
#endif
}
