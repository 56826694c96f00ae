// subsurface.frag for the pixels low .. high - 1. Definition FULL_FLOATS: radiance has 32-bit floats, not 16-bit ones.
#version 450
#include "lib/diffused_light.glsl"
#include "lib/radiance.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef FULL_FLOATS
layout(binding = 0, rgba32f) uniform image2D radiance;
#else
layout(binding = 0, rgba16f) uniform image2D radiance;
#endif

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
    vec4 before = imageLoad(radiance, pixel);
    vec3 light = storable(diffused_light(vec2(pixel) + 0.5, here));
    imageStore(radiance, pixel, vec4(storable(before.rgb + light), before.a));
}
