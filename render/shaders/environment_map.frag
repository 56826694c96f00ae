// Highlights of all lights by one fetch from a sphere map (fakephong.envmap). Definition SINGLE_LIGHTS, which is 1.
// Techniques: fakephong.envmap
#version 450
#include "lib/map_pixel.glsl"

void main() {
    radiance = map_radiance(diffuse, specular + map_factor[0] * map_texel(map_at[0].xy, highlight_layer));
}
