// Forward-shaded surfaces with all lights that reach their object (light.structure-object-major).
// Techniques: fakephong.phong, light.structure-object-major
#version 450
#include "lib/lighting.glsl"
#include "lib/forward.glsl"

layout(location = 6) flat in uint object;
layout(location = 0) out vec4 radiance;

void main() {
    SurfaceSample s = forward_surface();
    vec3 position_ws = world_position(gl_FragCoord.xy, surface_depth);
    // Here light_cells holds the lists of objects, not of cells.
    uvec2 list = uvec2(0u);
#ifdef LOCAL_LIGHTS
    list = texelFetch(light_cells, int(object)).xy;
#endif
    Reflected light = reflect_all(s, position_ws, gl_FragCoord.xy, list);
    radiance = vec4(storable(visible_emission(s, position_ws) + light.diffuse + light.specular), 1.0);
}
