// Downsamples the image to half resolution with a firefly clamp. Alpha: fraction of its light that a texel passes on.
// Definition ANY_SIZE: the sizes are not exactly 2 : 1.
#version 450
#include "lib/pyramid.glsl"
#include "lib/tone.glsl"
#include "tone_gpu.h"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;

uniform ivec2 size;             // of the target
uniform float inverse_firefly;  // 1 / luminance of a firefly; 0: no clamp

layout(location = 0) out vec4 passed_on;

// Means of the pixels in the four quadrants around the texel's center.
struct Quarters {
    vec3 left_down;
    vec3 right_down;
    vec3 left_up;
    vec3 right_up;
};

Quarters read_quarters() {
    Quarters q;
#ifdef ANY_SIZE
    ivec2 last = textureSize(scene_radiance, 0) - 1;
    vec2 ratio = vec2(last + 1) / vec2(size);
    vec2 center = gl_FragCoord.xy * ratio;
    ivec2 begin = ivec2(floor(center - ratio));
    q = Quarters(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    for (int y = 0; y < 5; ++y) {
        vec2 rows = vec2(begin.y + y, begin.y + y + 1);
        vec2 below = min(rows, center.y);
        vec2 above = max(rows, center.y);
        float down = 2.0 * tent_fraction(below.x, below.y, center.y, ratio.y);
        float up = 2.0 * tent_fraction(above.x, above.y, center.y, ratio.y);
        for (int x = 0; x < 5; ++x) {
            vec2 columns = vec2(begin.x + x, begin.x + x + 1);
            vec2 before = min(columns, center.x);
            vec2 behind = max(columns, center.x);
            float left = 2.0 * tent_fraction(before.x, before.y, center.x, ratio.x);
            float right = 2.0 * tent_fraction(behind.x, behind.y, center.x, ratio.x);
            // At most one pixel beyond the border, where clamping equals mirroring.
            vec3 light = texelFetch(scene_radiance, clamp(begin + ivec2(x, y), ivec2(0), last), 0).rgb;
            q.left_down += left * down * light;
            q.right_down += right * down * light;
            q.left_up += left * up * light;
            q.right_up += right * up * light;
        }
    }
#else
    // Each bilinear fetch weights a pixel and its neighbor 3 : 1.
    vec2 texel = 0.5 / vec2(size);
    vec2 near = (2.0 * gl_FragCoord.xy - 0.75) * texel;
    vec2 far = (2.0 * gl_FragCoord.xy + 0.75) * texel;
    q.left_down = texture(scene_radiance, near).rgb;
    q.right_down = texture(scene_radiance, vec2(far.x, near.y)).rgb;
    q.left_up = texture(scene_radiance, vec2(near.x, far.y)).rgb;
    q.right_up = texture(scene_radiance, far).rgb;
#endif
    return q;
}

void main() {
    Quarters q = read_quarters();
    vec3 mean = 0.25 * q.left_down + 0.25 * q.right_down + 0.25 * q.left_up + 0.25 * q.right_up;

    // Weighted mean with 1 / (1 + luminance): Karis 2013.
    vec4 light = vec4(
        luminance(q.left_down), luminance(q.right_down), luminance(q.left_up), luminance(q.right_up));
    light = max(light, 0.0);
    vec4 weight = 1.0 / (1.0 + light * inverse_firefly);
    float plain = dot(light, vec4(0.25));
    float weighted = dot(weight, light) / dot(weight, vec4(1.0));
    float fraction = plain > 0.0 ? min(weighted / plain, 1.0) : 1.0;

    float peak = max(mean.r, max(mean.g, mean.b));
    fraction = min(fraction, kMaxHalf / max(peak, 1.0));
    // Drops texels with NaN or infinity in any pixel.
    bool known = is_finite(mean) && is_finite(fraction);
    passed_on = known ? vec4(fraction * mean, fraction) : vec4(0.0);
}
