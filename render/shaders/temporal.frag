// Blends the current frame into the reprojected history. See temporal_pass.h.
// Techniques: post.temporal
#version 450
#include "lib/numbers.glsl"
#include "lib/view.glsl"
#include "fullscreen_gpu.h"
#include "temporal_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D radiance;
layout(binding = kHistoryUnit) uniform sampler2D history;
layout(binding = kTemporalVelocityUnit) uniform sampler2D velocity_map;
layout(binding = kTemporalDepthUnit) uniform sampler2D depth_map;
layout(binding = kMomentsUnit) uniform sampler2D moments;  // x: frames in history, y: temporal variance of static pixels

uniform int has_history;

layout(location = 0) out vec4 resolved;
layout(location = 1) out vec2 resolved_moments;

const float kStill = 0.02;            // motion less than this [px] is rounding
const float kMaxFramesStill = 32.0;   // maximum frames in history for static pixels
const float kMaxFramesMoving = 10.0;  // and for moving ones, as resampling softens
const float kSpread = 1.0;            // clamp of history [standard deviations of the neighborhood] for moving pixels
const float kSpreadStill = 2.0;       // and for static ones, plus its temporal deviation, as thin objects come and go
                                    // with the jitter

vec3 to_ycocg(vec3 c) {
    return vec3(
        0.25 * c.r + 0.5 * c.g + 0.25 * c.b, 0.5 * c.r - 0.5 * c.b, -0.25 * c.r + 0.5 * c.g - 0.25 * c.b);
}

vec3 from_ycocg(vec3 c) {
    float base = c.x - c.z;
    return vec3(base + c.y, c.x + c.z, base - c.y);
}

vec3 sanitize(vec3 c) {
    return mix(clamp(c, vec3(0.0), vec3(65504.0)), vec3(0.0), is_nan(c));
}

// Bicubic (Catmull-Rom) without its corners: five bilinear fetches (Jimenez 2016).
vec3 read_history(vec2 at) {
    vec2 size = vec2(textureSize(history, 0));
    vec2 center = floor(at - 0.5) + 0.5;
    vec2 f = at - center;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 near = (center - 1.0) / size;
    vec2 center_tap = (center + w2 / w12) / size;
    vec2 far = (center + 2.0) / size;
    float up = w12.x * w0.y;
    float left = w0.x * w12.y;
    float inner = w12.x * w12.y;
    float right = w3.x * w12.y;
    float down = w12.x * w3.y;
    vec3 sum = up * textureLod(history, vec2(center_tap.x, near.y), 0.0).rgb
               + left * textureLod(history, vec2(near.x, center_tap.y), 0.0).rgb
               + right * textureLod(history, vec2(far.x, center_tap.y), 0.0).rgb
               + down * textureLod(history, vec2(center_tap.x, far.y), 0.0).rgb;
    sum += inner * textureLod(history, center_tap, 0.0).rgb;
    return max(sum / (up + left + inner + right + down), vec3(0.0));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(radiance, 0) - 1;

    // Mean and deviation of the neighborhood, and its nearest pixel, whose velocity is used so that edges of moving
    // objects stay smooth.
    vec3 center = vec3(0.0);
    vec3 mean = vec3(0.0);
    vec3 squares = vec3(0.0);
    float nearest = -1.0;
    ivec2 nearest_at = pixel;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
            vec3 color = to_ycocg(sanitize(texelFetch(radiance, at, 0).rgb));
            mean += color;
            squares += color * color;
            if (x == 0 && y == 0) {
                center = color;
            }
            float depth = texelFetch(depth_map, at, 0).r;
            if (depth > nearest) {
                nearest = depth;
                nearest_at = at;
            }
        }
    }
    mean /= 9.0;
    vec3 spread = sqrt(max(squares / 9.0 - mean * mean, vec3(0.0)));

    vec2 velocity = texelFetch(velocity_map, nearest_at, 0).xy;
    vec2 moved = velocity * view.size.xy;
    vec2 from = gl_FragCoord.xy - moved;
    bool inside = is_finite(from) && all(greaterThanEqual(from, vec2(0.0))) && all(lessThanEqual(from, view.size.xy));
    if (has_history == 0 || !inside) {
        resolved = vec4(from_ycocg(center), 1.0);
        resolved_moments = vec2(1.0, 0.0);
        return;
    }

    bool still = dot(moved, moved) < kStill * kStill;
    vec3 reprojected = still ? texelFetch(history, pixel, 0).rgb : read_history(from);
    vec3 kept = to_ycocg(sanitize(reprojected));
    vec2 moment = texelFetch(moments, clamp(ivec2(from), ivec2(0), last), 0).xy;
    float count = clamp(moment.x, 1.0, still ? kMaxFramesStill : kMaxFramesMoving);

    float variance = still ? moment.y : 0.0;
    vec3 apart = abs(center - kept);
    float deviation = max(max(apart.x, apart.y), apart.z);

    // Clamps history toward the mean of the neighborhood.
    vec3 allowed = kSpread * spread;
    if (still) {
        allowed = kSpreadStill * (spread + sqrt(variance));
    }
    vec3 off = (kept - mean) / max(allowed, vec3(1e-4 * mean.x + 1e-6));
    float excess = max(max(abs(off.x), abs(off.y)), abs(off.z));
    if (excess > 1.0) {
        kept = mean + (kept - mean) / excess;
        count = max(count / excess, 1.0);
    }

    // With little history, bright frames are weighted less to prevent flicker; with more, it approaches a mean.
    float weight = 1.0 / (count + 1.0);
    float luminance_scale = 3.0 * weight;
    float weight_now = weight / (1.0 + luminance_scale * center.x);
    float weight_past = (1.0 - weight) / (1.0 + luminance_scale * kept.x);
    vec3 mixed = (weight_now * center + weight_past * kept) / (weight_now + weight_past);
    resolved = vec4(max(from_ycocg(mixed), vec3(0.0)), 1.0);
    resolved_moments = vec2(count + 1.0, mix(variance, deviation * deviation, still ? min(weight, 0.1) : 0.0));
}
