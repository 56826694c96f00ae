// Highlights of all lights by one fetch from a map (fakephong.envmap). Definitions SINGLE_LIGHTS, which is 1, and
// ENVIRONMENT_LAYOUT.
// Techniques: fakephong.envmap
#version 450
#include "lib/map_pixel.glsl"
#include "lib/highlight_layout.glsl"

void main() {
#if ENVIRONMENT_LAYOUT == 0
    vec2 place = map_at[0].xy;
#else
    vec2 place = map_place(map_at[0]);
#endif
    radiance = map_radiance(diffuse, specular + map_factor[0] * map_texel(place, highlight_layer));
}
