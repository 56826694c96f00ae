// Lit per vertex, but with coordinates in a Blinn map for highlights, one pair per light (fakephong.blinn-map).
// Definitions SINGLE_LIGHTS and WORST_AXIS: lib/single_lights.glsl, lib/highlight_map.glsl.
// Techniques: fakephong.blinn-map
#version 450
#include "lib/map_vertex.glsl"

vec2 map_coordinates(LitPoint p, vec3 to_light) {
    return blinn_coordinates(p.reflector.normal, to_light, p.reflector.to_camera);
}

#include "lib/map_lights.glsl"
