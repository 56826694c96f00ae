// Replaces a fraction of each pixel's light by light scattered in the lens. Definition ANY_SIZE: the sizes are not
// exactly 2 : 1.
#version 450
#include "lib/pyramid.glsl"
#include "lib/radiance.glsl"
#include "fullscreen_gpu.h"
#include "glow_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kGlowUnit) uniform sampler2D glow;  // alpha: fraction of light passed on (glow_first.frag)

uniform float strength;

layout(location = 0) out vec4 radiance;

// The transpose of the step in glow_first.frag: the mean of bilinear interpolation over the pixel.
vec4 glow_at_pixel(ivec2 size) {
    ivec2 glow_size = textureSize(glow, 0);
#ifdef ANY_SIZE
    vec2 ratio = vec2(size) / vec2(glow_size);
    vec2 from = floor(gl_FragCoord.xy);
    ivec2 begin = ivec2(floor(from / ratio - 0.5));
    vec4 mean = vec4(0.0);
    for (int y = 0; y < 3; ++y) {
        float weight_y = tent_fraction(from.y, from.y + 1.0, (float(begin.y + y) + 0.5) * ratio.y, ratio.y);
        for (int x = 0; x < 3; ++x) {
            float weight_x = tent_fraction(from.x, from.x + 1.0, (float(begin.x + x) + 0.5) * ratio.x, ratio.x);
            mean += weight_x * weight_y * texelFetch(glow, clamp(begin + ivec2(x, y), ivec2(0), glow_size - 1), 0);
        }
    }
    return ratio.x * ratio.y * mean;
#else
    return texture(glow, 0.5 * gl_FragCoord.xy / vec2(glow_size));
#endif
}

void main() {
    vec4 scene = texelFetch(scene_radiance, ivec2(gl_FragCoord.xy), 0);
    vec4 scattered = glow_at_pixel(textureSize(scene_radiance, 0));
    radiance = vec4(storable(scene.rgb * (1.0 - strength * scattered.a) + strength * scattered.rgb), scene.a);
}
