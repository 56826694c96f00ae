// Highlights by one fetch per light from a Blinn map (fakephong.blinn-map, fakephong.blinn-texture); none if the light
// is behind the surface, as in lit(). Definitions SINGLE_LIGHTS and BLINN_DIFFUSE: lib/single_lights.glsl,
// lib/map_lights.glsl.
// Techniques: fakephong.blinn-map
#version 450
#include "lib/map_pixel.glsl"

void main() {
    vec3 tinted = diffuse;
    vec3 highlights = specular;
    for (int k = 0; k < SINGLE_LIGHTS; ++k) {
        highlights += map_at[k].z > 0.0 ? map_factor[k] * map_texel(map_at[k].xy, highlight_layer).r : vec3(0.0);
#ifdef BLINN_DIFFUSE
        tinted += diffuse_factor[k] * map_texel(diffuse_at[k], kDiffuseLayer).r;
#endif
    }
    radiance = map_radiance(tinted, highlights);
}
