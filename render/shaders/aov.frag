// One attribute of the G-buffer as plain numbers, for files and the buffer viewer.
//   AOV  0 depth, 1 normal, 2 albedo, 3 velocity, 4 emission: the order of aov_names()
#version 450
#include "lib/gbuffer.glsl"
#include "lib/view.glsl"

layout(binding = 5) uniform usampler2D gbuffer;
layout(binding = 6) uniform sampler2D scene_depth;
#if AOV == 3
layout(binding = 14) uniform sampler2D scene_velocity;
#endif

layout(location = 0) out vec4 value;

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
#else
    value = vec4(s.emission, 1.0);
#endif
}
