// Forward-shaded light of a single light, blended additively (light.structure-light-major).
// Techniques: light.structure-light-major
#version 450
#include "lib/lighting.glsl"
#include "lib/forward.glsl"
#include "lib/one_light.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    SurfaceSample s = forward_surface();
    vec3 position_ws = world_position(gl_FragCoord.xy, surface_depth);
    radiance = vec4(storable(reflect_one(s, position_ws, gl_FragCoord.xy)), 0.0);
}
