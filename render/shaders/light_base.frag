// Light of every surface without lights: emission and environment. The base of the passes that add one light each.
#version 450
#include "lib/lighting.glsl"

layout(binding = 5) uniform usampler2D gbuffer;
layout(binding = 6) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    SurfaceSample s = unpack_surface(texelFetch(gbuffer, pixel, 0));
    vec3 position_ws = world_position(gl_FragCoord.xy, texelFetch(scene_depth, pixel, 0).r);
    Reflector r = make_reflector(s, to_viewer(position_ws));
    Reflected around = reflect_surroundings(r, s, position_ws);
    radiance = vec4(storable(s.emission + around.diffuse + around.specular), 1.0);
}
