// Diffuse light by one fetch per light (fakephong.phong-map). Definition SINGLE_LIGHTS: lib/single_lights.glsl.
// Techniques: fakephong.phong-map
#version 450
#include "lib/map_pixel.glsl"

void main() {
    vec3 tinted = diffuse;
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        tinted += map_factor[k] * map_texel(map_at[k].xy, kDiffuseLayer).r;
    }
    radiance = map_radiance(tinted, specular);
}
