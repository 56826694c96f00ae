// Reflected light of a single light, added to the target (deferred.light-pass).
#version 450
#include "lib/lighting.glsl"
#include "lib/one_light.glsl"

layout(binding = 5) uniform usampler2D gbuffer;
layout(binding = 6) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
    vec3 position_ws = world_position(gl_FragCoord.xy, texelFetch(scene_depth, pixel, 0).r);
    radiance = vec4(storable(reflect_one(s, position_ws, gl_FragCoord.xy)), 0.0);
}
