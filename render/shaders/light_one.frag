// Reflected light of a single light, added to the target (deferred.light-pass).
#version 450
#include "lib/lighting.glsl"
#include "lib/one_light.glsl"
#include "lib/stored_surface.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    SurfaceSample s = stored_surface(pixel);
    vec3 position_ws = world_position(gl_FragCoord.xy, texelFetch(scene_depth, pixel, 0).r);
    radiance = vec4(storable(reflect_one(s, position_ws, gl_FragCoord.xy)), 0.0);
}
