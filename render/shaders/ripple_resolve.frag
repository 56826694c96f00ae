// The image at shifted positions. Of the four texels around a position, those in front of the rippling region are
// ignored; where all are, and where nothing ripples, the pixel stays bit-identical.
#version 450
#include "fullscreen_gpu.h"
#include "gbuffer_gpu.h"
#include "ripple_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kRippleFieldUnit) uniform sampler2D ripple_field;
layout(binding = kDepthUnit) uniform sampler2D scene_depth;

layout(location = 0) out vec4 radiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(scene_radiance, 0) - 1;
    vec4 field = texelFetch(ripple_field, pixel, 0);
    bool moved = field.xy != vec2(0.0);
    vec4 stays = texelFetch(scene_radiance, pixel, 0);

    vec2 position = vec2(pixel) + field.xy;
    vec2 corner = floor(position);
    vec2 fraction = position - corner;
    vec4 sum = vec4(0.0);
    // On a software OpenGL, a loop that no pixel of a group enters is free; a branch is not.
    for (int i = 0; i < (moved ? 4 : 0); ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 at = clamp(ivec2(corner) + step, ivec2(0), last);
        vec2 weights = mix(1.0 - fraction, fraction, vec2(step));
        float weight = weights.x * weights.y;
        bool counts = weight > 0.0 && texelFetch(scene_depth, at, 0).r < field.w;
        sum += counts ? weight * vec4(texelFetch(scene_radiance, at, 0).rgb, 1.0) : vec4(0.0);
    }
    radiance = sum.w > 0.0 ? vec4(sum.rgb / sum.w, stays.a) : stays;
}
