// Texture coordinates for diffuse light, one pair per light: L projected on the plane orthogonal to N
// (fakephong.phong-map, after H. Elias). Light from behind maps to the rim. There are no highlights. Definitions
// SINGLE_LIGHTS and WORST_AXIS: lib/single_lights.glsl, lib/highlight_map.glsl.
// Techniques: fakephong.phong-map
#version 450
#define MAP_DIFFUSE
#include "lib/map_vertex.glsl"

vec2 map_coordinates(LitPoint p, vec3 to_light) {
    return plane_coordinates(to_light, p.reflector.normal);
}

#include "lib/map_lights.glsl"
