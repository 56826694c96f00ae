// Lit at vertices, but highlights by the mirrored view direction in a map that holds all lights (fakephong.envmap): its
// coordinates in a sphere map, or itself (ENVIRONMENT_LAYOUT). Definition SINGLE_LIGHTS, which is 1.
// Techniques: fakephong.envmap
#version 450
#include "lib/map_vertex.glsl"
#include "lib/highlight_layout.glsl"

void main() {
    LitPoint p = put_vertex();
    vec3 mirrored = mirrored_view(p.reflector.normal, p.reflector.to_camera);
#if ENVIRONMENT_LAYOUT == 0
    map_at[0] = vec3(map_place(mirrored), 1.0);
#else
    map_at[0] = mirrored;
#endif
    map_factor[0] = p.single > 0 ? p.reflector.specular_0 / kPi : vec3(0.0);
    Reflected light = light_from(p, 0, p.single > 0 ? kEveryLight : 0, kEveryLight);
    diffuse = light.diffuse;
    specular = light.specular;
}
