// A picture at half its size: each texel is what lies under a tent twice as wide. Definitions:
//   ANY_SIZE  the sizes are not exactly 2 : 1
//   FIRST     from the scene's radiance: lone bright pixels count less. Alpha is the share of its light that the
//             texel passes on
#version 450
#include "lib/pyramid.glsl"
#include "lib/tone.glsl"
#include "tone_gpu.h"

layout(binding = 0) uniform sampler2D source;

#ifdef ANY_SIZE
uniform ivec2 size;  // of the target
#endif
#ifdef FIRST
uniform float per_firefly;  // 1 over the luminance of a firefly; 0: there are none
#endif

layout(location = 0) out vec4 shrunk;

#ifdef FIRST
// The mean of four neighboring groups of pixels, and which share of it is no firefly's.
vec4 without_fireflies(vec3 a, vec3 b, vec3 c, vec3 d) {
    vec3 mean = 0.25 * a + 0.25 * b + 0.25 * c + 0.25 * d;
    if (!is_finite(mean)) {
        return vec4(0.0);
    }
    vec4 light = max(vec4(luminance(a), luminance(b), luminance(c), luminance(d)), 0.0);
    vec4 weight = 1.0 / (1.0 + light * per_firefly);
    float plain = 0.25 * light.x + 0.25 * light.y + 0.25 * light.z + 0.25 * light.w;
    float weighted = dot(weight, light) / dot(weight, vec4(1.0));
    float passed = min(weighted / max(plain, 1e-30), 1.0);
    float peak = max(mean.r, max(mean.g, mean.b));
    passed = min(plain > 0.0 ? passed : 1.0, kMostLight / max(peak, 1.0));
    return vec4(passed * mean, passed);
}
#endif

void main() {
#ifdef ANY_SIZE
    ivec2 source_size = textureSize(source, 0);
    vec2 ratio = vec2(source_size) / vec2(size);
    vec2 middle = gl_FragCoord.xy * ratio;
    ivec2 begin = ivec2(floor(middle - ratio));
    vec3 left_down = vec3(0.0);
    vec3 right_down = vec3(0.0);
    vec3 left_up = vec3(0.0);
    vec3 right_up = vec3(0.0);
    for (int y = 0; y < 5; ++y) {
        float at_y = float(begin.y + y);
        float down = 2.0 * tent_share(min(at_y, middle.y), min(at_y + 1.0, middle.y), middle.y, ratio.y);
        float up = 2.0 * tent_share(max(at_y, middle.y), max(at_y + 1.0, middle.y), middle.y, ratio.y);
        for (int x = 0; x < 5; ++x) {
            float at_x = float(begin.x + x);
            float left = 2.0 * tent_share(min(at_x, middle.x), min(at_x + 1.0, middle.x), middle.x, ratio.x);
            float right = 2.0 * tent_share(max(at_x, middle.x), max(at_x + 1.0, middle.x), middle.x, ratio.x);
            vec3 texel = texelFetch(source, clamp(begin + ivec2(x, y), ivec2(0), source_size - 1), 0).rgb;
            left_down += left * down * texel;
            right_down += right * down * texel;
            left_up += left * up * texel;
            right_up += right * up * texel;
        }
    }
#else
    // Each reading weighs a pixel and its neighbor 3 : 1.
    vec2 texel = 0.5 / vec2(textureSize(source, 0));
    vec2 near = (4.0 * gl_FragCoord.xy - 1.5) * texel;
    vec2 far = (4.0 * gl_FragCoord.xy + 1.5) * texel;
    vec3 left_down = texture(source, near).rgb;
    vec3 right_down = texture(source, vec2(far.x, near.y)).rgb;
    vec3 left_up = texture(source, vec2(near.x, far.y)).rgb;
    vec3 right_up = texture(source, far).rgb;
#endif
#ifdef FIRST
    shrunk = without_fireflies(left_down, right_down, left_up, right_up);
#else
    shrunk = vec4(0.25 * (left_down + right_down + left_up + right_up), 1.0);
#endif
}
