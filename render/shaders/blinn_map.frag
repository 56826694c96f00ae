// Highlights by one fetch per light from a Blinn map (fakephong.blinn-map, fakephong.blinn-texture); none where the
// light is behind the surface, as in lit(). Definition SINGLE_LIGHTS: lib/single_lights.glsl.
#version 450
#include "lib/map_pixel.glsl"

void main() {
    vec3 highlights = specular;
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        highlights += map_at[k].z > 0.0 ? map_factor[k] * map_texel(k, highlight_layer).r : vec3(0.0);
    }
    radiance = map_radiance(diffuse, highlights);
}
