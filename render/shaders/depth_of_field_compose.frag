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
layout(binding = kFocusSmallNearUnit) uniform sampler2D small_near;  // of small circles, per block
layout(binding = kFocusNearCoarseUnit) uniform sampler2D near_coarse;  // quarter resolution

flat in vec4 tile;

layout(location = 0) out vec4 color;

// Weight of a pixel in neither the near nor the far layer.
float slight_weight(float diameter) {
    return clamp(kHalfResDiameter - abs(diameter), 0.0, 1.0);
}

#ifdef SLIGHT

// Gathers small circles, of at most `range`, at full resolution, as depth_of_field_gather.frag does large ones; alpha:
// coverage.
vec4 slightly_blurred(ivec2 here, float own, float range) {
    ivec2 last = ivec2(focus.size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < kSlightTaps && focus.pixel[i].z < range + 0.5; ++i) {
        vec4 pixel = texelFetch(packed_pixels, clamp(here + ivec2(focus.pixel[i].xy), ivec2(0), last), 0);
        float radius = min(abs(pixel.a), pixel.a > own ? abs(own) : 0.5 * kHalfResDiameter);
        int index = int(float(kSlightStep) * min(radius, 0.5 * kHalfResDiameter) + 0.5);
        float covered = clamp(float(index) / float(kSlightStep) + 0.5 - focus.pixel[i].z, 0.0, 1.0);
        float weight = covered * focus.area[index >> 2][index & 3] * slight_weight(2.0 * pixel.a);
        sum += weight * vec4(pixel.rgb, 1.0);
    }
    return sum;
}

#endif

#ifdef BLURRED

const float kOpaque = 0.97;  // coverage from which a near surface is opaque

// A loop is skipped, a branch might be flattened.
vec4 texture_if(sampler2D image, vec2 uv, bool wanted) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (wanted ? 1 : 0); ++i) {
        sum += textureLod(image, uv, 0.0);
    }
    return sum;
}

// Background occluded by a near object, inpainted from its surroundings: from the finest mip level that has any.
vec4 inpainted(vec2 uv, int levels) {
    vec4 found = vec4(0.0);
    for (int level = 0; level < levels && found.a < 0.99; ++level) {
        vec4 more = textureLod(behind_near, uv, float(level));
        found += (1.0 - found.a) * more * (min(4.0 * more.a, 1.0) / max(more.a, 1e-5));
    }
    return found;
}

#endif

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
#if defined(SLIGHT) || defined(BLURRED)
    vec4 own = texelFetch(packed_pixels, here, 0);
    float weight = slight_weight(2.0 * own.a);
    vec4 shown = vec4(own.rgb * weight, weight);
#ifdef SLIGHT
    float range = max(texelFetch(small_near, here / kFocusBlock, 0).x, min(abs(own.a), 0.5 * kHalfResDiameter));
    shown = range > 0.5 ? slightly_blurred(here, own.a, range) : shown;
#endif
    color = vec4(shown.a > 1e-4 ? shown.rgb / shown.a : own.rgb, 1.0);
#else
    color = texelFetch(scene_radiance, here, 0);
#endif
#ifdef BLURRED
    vec2 uv = 0.5 * gl_FragCoord.xy / focus.size.zw;
    vec4 far = texture_if(far_blurred, uv, tile.z > 0.0);
    vec4 near = texture_if(near_blurred, uv, max(tile.x, tile.y) > 0.0);
    float is_near = near_weight(2.0 * own.a);
    vec2 uv_coarse = 0.25 * gl_FragCoord.xy / vec2(textureSize(near_coarse, 0));
    float coarse_coverage = texture_if(near_coarse, uv_coarse, tile.y > 0.0 && is_near > 0.0 && shown.a > 0.0).a;
    if (is_near > 0.0) {
        // Parts of one surface do not occlude each other; but wide circles occlude small ones.
        shown = near + max(1.0 - coarse_coverage, 0.0) * shown;
        near = vec4(0.0);
    }
    vec4 behind = inpainted(uv, is_near > 0.0 && shown.a < kOpaque ? textureQueryLevels(behind_near) : 0);
    vec4 all = is_near > 0.0 ? shown / max(shown.a, 1e-4) : vec4(0.0);  // fallback
    behind = is_near > 0.0 ? behind + (1.0 - min(behind.a, 1.0)) * all : far;
    if (behind.a > 1e-4) {
        color.rgb = shown.rgb / max(shown.a, 1.0) + max(1.0 - shown.a, 0.0) * behind.rgb / behind.a;
    }
    color.rgb = color.rgb * (1.0 - near.a) + near.rgb;
#endif
}
