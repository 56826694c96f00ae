// Downsamples to half resolution and sorts pixels into layers: far, near, and everything behind near; the first two are
// split into fine and wide circles. Alpha: weight in the texel.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusPackedUnit) uniform sampler2D packed_pixels;

layout(location = 0) out vec4 far_light;     // fine
layout(location = 1) out vec4 near_light;    // fine
layout(location = 2) out vec4 far_kernels;   // by brightness; by coverage
layout(location = 3) out vec2 near_kernels;  // by brightness
layout(location = 4) out vec4 far_wide;      // coarse
layout(location = 5) out vec4 near_wide;     // coarse
layout(location = 6) out vec2 wide_radii;    // [px] of both, times radius_weight
layout(location = 7) out vec4 behind_near;

// The filter is a tent over 4 x 4 pixels, which preserves the position and width of a light anywhere in the texel.

void main() {
    ivec2 first = 2 * ivec2(gl_FragCoord.xy) - 1;
    ivec2 last = ivec2(focus.size.xy) - 1;
    far_light = vec4(0.0);
    near_light = vec4(0.0);
    far_wide = vec4(0.0);
    near_wide = vec4(0.0);
    behind_near = vec4(0.0);
    wide_radii = vec2(0.0);
    vec3 radii = vec3(0.0);
    for (int i = 0; i < 16; ++i) {
        ivec2 offset = ivec2(i & 3, i >> 2);
        vec4 pixel = texelFetch(packed_pixels, clamp(first + offset, ivec2(0), last), 0);
        vec2 tent = mix(vec2(0.375), vec2(0.125), notEqual(offset - 1 & 2, ivec2(0)));
        float weight = pixel.a == kUnknown ? 0.0 : tent.x * tent.y;
        vec4 light = weight * vec4(pixel.rgb, 1.0);
        vec2 layers = vec2(far_weight(2.0 * pixel.a), near_weight(2.0 * pixel.a));
        vec2 wide = layers * coarse_weight(abs(pixel.a));
        vec2 fine = layers - wide;
        far_light += fine.x * light;
        near_light += fine.y * light;
        far_wide += wide.x * light;
        near_wide += wide.y * light;
        behind_near += layers.y > 0.0 ? vec4(0.0) : light;
        float brightness = radius_weight(light);
        radii += abs(pixel.a) * vec3(fine.x * brightness, fine.x * weight, fine.y * brightness);
        wide_radii += abs(pixel.a) * brightness * wide;
    }
    far_kernels.xy = kernel_of(radii.x / max(radius_weight(far_light), 1e-20));
    far_kernels.zw = kernel_of(radii.y / max(far_light.a, 1e-20));
    near_kernels = kernel_of(radii.z / max(radius_weight(near_light), 1e-20));
}
