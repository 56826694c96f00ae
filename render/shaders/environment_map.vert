// Lit at vertices, but highlights by the coordinates of the mirrored view direction in a sphere map that holds all
// lights (fakephong.envmap). Definition SINGLE_LIGHTS, which is 1.
// Techniques: fakephong.envmap
#version 450
#include "lib/map_vertex.glsl"

void main() {
    LitPoint p = put_vertex();
    map_at[0] = vec3(sphere_map_coordinates(p.reflector.normal, p.reflector.to_camera), 1.0);
    map_factor[0] = p.single > 0 ? p.reflector.specular_0 / kPi : vec3(0.0);
    Reflected light = light_from(p, 0, p.single > 0 ? kEveryLight : 0, kEveryLight);
    diffuse = light.diffuse;
    specular = light.specular;
}
