// Deferred shading: one pass over the G-buffer, each pixel with the lights of its cluster cell.
#version 450
#include "lib/lighting.glsl"
#include "lib/stored_surface.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(scene_depth, pixel, 0).r;
    SurfaceSample s = stored_surface(pixel);
    Reflected light = reflect_all(
        s, world_position(gl_FragCoord.xy, depth), gl_FragCoord.xy, cell_list(gl_FragCoord.xy, view_distance(depth)));
    radiance = vec4(storable(s.emission + light.diffuse + light.specular), 1.0);
}
