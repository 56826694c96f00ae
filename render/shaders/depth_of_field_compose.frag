// Composes the final image: sharp and slightly blurred pixels at full resolution, the far layer from half resolution,
// and the near layer over both.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusRadianceUnit) uniform sampler2D scene_radiance;
layout(binding = kFocusPackedUnit) uniform sampler2D packed_pixels;
layout(binding = kFocusFarBlurredUnit) uniform sampler2D far_blurred;
layout(binding = kFocusNearBlurredUnit) uniform sampler2D near_blurred;
layout(binding = kFocusBehindNearUnit) uniform sampler2D behind_near;
layout(binding = kFocusNearReachUnit) uniform sampler2D near_reach;  // of small circles, per block
layout(binding = kFocusNearCoarseUnit) uniform sampler2D near_coarse;  // quarter resolution

flat in vec4 tile;

layout(location = 0) out vec4 color;

// Share of a pixel in neither the near nor the far layer.
float slight_share(float diameter) {
    return clamp(kHalfResDiameter - abs(diameter), 0.0, 1.0);
}

#ifdef SLIGHT

// Gathers small circles pixel by pixel, as depth_of_field_gather.frag does large ones; alpha: coverage. None is wider here than
// `reach`.
vec4 slightly_blurred(ivec2 here, float own, float reach) {
    ivec2 last = ivec2(focus.size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < kSlightTaps && focus.pixel[i].z < reach + 0.5; ++i) {
        vec4 seen = texelFetch(packed_pixels, clamp(here + ivec2(focus.pixel[i].xy), ivec2(0), last), 0);
        float radius = min(abs(seen.a), seen.a > own ? abs(own) : 0.5 * kHalfResDiameter);
        int place = int(float(kSlightStep) * min(radius, 0.5 * kHalfResDiameter) + 0.5);
        float covered = clamp(float(place) / float(kSlightStep) + 0.5 - focus.pixel[i].z, 0.0, 1.0);
        float weight = covered * focus.area[place >> 2][place & 3] * slight_share(2.0 * seen.a);
        sum += weight * vec4(seen.rgb, 1.0);
    }
    return sum;
}

#endif

#ifdef BLURRED

const float kOpaque = 0.97;  // coverage from which a near surface hides everything

// A loop is skipped, a branch might be flattened.
vec4 texture_if(sampler2D image, vec2 uv, bool wanted) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (wanted ? 1 : 0); ++i) {
        sum += textureLod(image, uv, 0.0);
    }
    return sum;
}

// Background hidden by a near object, filled in from its surroundings: from the finest mip level that has any.
vec4 hidden(vec2 uv, int levels) {
    vec4 known = vec4(0.0);
    for (int level = 0; level < levels && known.a < 0.99; ++level) {
        vec4 more = textureLod(behind_near, uv, float(level));
        known += (1.0 - known.a) * more * (min(4.0 * more.a, 1.0) / max(more.a, 1e-5));
    }
    return known;
}

#endif

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
#if defined(SLIGHT) || defined(BLURRED)
    vec4 own = texelFetch(packed_pixels, here, 0);
    float share = slight_share(2.0 * own.a);
    vec4 shown = vec4(own.rgb * share, share);
#ifdef SLIGHT
    float reach = max(texelFetch(near_reach, here / kFocusBlock, 0).x, min(abs(own.a), 0.5 * kHalfResDiameter));
    shown = reach > 0.5 ? slightly_blurred(here, own.a, reach) : shown;
#endif
    color = vec4(shown.a > 1e-4 ? shown.rgb / shown.a : own.rgb, 1.0);
#else
    color = texelFetch(scene_radiance, here, 0);
#endif
#ifdef BLURRED
    vec2 uv = 0.5 * gl_FragCoord.xy / focus.size.zw;
    vec4 far = texture_if(far_blurred, uv, tile.z > 0.0);
    vec4 near = texture_if(near_blurred, uv, max(tile.x, tile.y) > 0.0);
    float is_near = near_share(2.0 * own.a);
    vec2 uv_coarse = 0.25 * gl_FragCoord.xy / vec2(textureSize(near_coarse, 0));
    float hidden_share = texture_if(near_coarse, uv_coarse, tile.y > 0.0 && is_near > 0.0 && shown.a > 0.0).a;
    if (is_near > 0.0) {
        // Parts of one surface, which do not hide each other; but wide circles hide slight ones.
        shown = near + max(1.0 - hidden_share, 0.0) * shown;
        near = vec4(0.0);
    }
    vec4 behind = hidden(uv, is_near > 0.0 && shown.a < kOpaque ? textureQueryLevels(behind_near) : 0);
    vec4 all = is_near > 0.0 ? shown / max(shown.a, 1e-4) : vec4(0.0);  // fallback
    behind = is_near > 0.0 ? behind + (1.0 - min(behind.a, 1.0)) * all : far;
    if (behind.a > 1e-4) {
        color.rgb = shown.rgb / max(shown.a, 1.0) + max(1.0 - shown.a, 0.0) * behind.rgb / behind.a;
    }
    color.rgb = color.rgb * (1.0 - near.a) + near.rgb;
#endif
}
