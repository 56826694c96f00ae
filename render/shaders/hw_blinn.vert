// The Blinn map as the vertex program of the thesis's appendix B computes it (fakephong.hw-blinn). Definitions
// SINGLE_LIGHTS, WORST_AXIS and HW_*: lib/single_lights.glsl, lib/highlight_map.glsl, lib/map_lights.glsl.
// Techniques: fakephong.hw-blinn
#version 450
#include "lib/map_vertex.glsl"

vec2 map_coordinates(LitPoint p, vec3 to_light) {
    return hardware_blinn_coordinates(p.reflector.normal, to_light, p.reflector.to_camera);
}

#include "lib/map_lights.glsl"
