// Deferred shading: one pass over the G-buffer, each pixel with the lights of its cluster cell.
#version 450
#include "lib/lighting.glsl"

layout(binding = 5) uniform usampler2D gbuffer;
layout(binding = 6) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(scene_depth, pixel, 0).r;
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
    Reflected light = reflect_all(
        s, world_position(gl_FragCoord.xy, depth), gl_FragCoord.xy, cell_list(gl_FragCoord.xy, view_distance(depth)));
    radiance = vec4(storable(s.emission + light.diffuse + light.specular), 1.0);
}
