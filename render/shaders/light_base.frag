// Light of every surface except from lights: emission and environment. The base of the passes that add one light each.
#version 450
#include "lib/lighting.glsl"
#include "lib/stored_surface.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    SurfaceSample s = stored_surface(pixel);
    vec3 position_ws = world_position(gl_FragCoord.xy, texelFetch(scene_depth, pixel, 0).r);
    Reflected around = reflect_around(s, position_ws);
    radiance = vec4(storable(visible_emission(s, position_ws) + around.diffuse + around.specular), 1.0);
}
