// Forward-shaded surfaces without lights, after the depth prepass: the base of the passes that add one light each
// (light.structure-light-major).
#version 450
#include "lib/lighting.glsl"
#include "lib/forward.glsl"

layout(location = 0) out vec4 radiance;

void main() {
    SurfaceSample s = forward_surface();
    vec3 position_ws = world_position(gl_FragCoord.xy, surface_depth);
    Reflected around = reflect_around(s, position_ws);
    radiance = vec4(storable(visible_emission(s, position_ws) + around.diffuse + around.specular), 1.0);
}
