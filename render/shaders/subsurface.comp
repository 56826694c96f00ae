// subsurface.frag for the pixels low .. high - 1. Definition: that of lib/radiance_image.glsl.
// Techniques: skin.diffusion
#version 450
#include "lib/diffused_light.glsl"
#include "lib/radiance_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform ivec2 low;
uniform ivec2 high;

void main() {
    ivec2 pixel = low + ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, high))) {
        return;
    }
    vec4 here = texelFetch(scattered, pixel, 0);
    if (here.a == 0.0) {
        return;
    }
    add_radiance(pixel, diffused_light(vec2(pixel) + 0.5, here));
}
