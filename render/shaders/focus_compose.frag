// The picture through the lens: sharp and slightly blurred from itself, far behind the focus from the half picture,
// and over that what stands far before it.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D scene_radiance;
layout(binding = 1) uniform sampler2D seen_pixels;
layout(binding = 2) uniform sampler2D far_blurred;
layout(binding = 3) uniform sampler2D near_blurred;
layout(binding = 4) uniform sampler2D behind_near;
layout(binding = 5) uniform sampler2D near_reach;  // of small circles, by blocks
layout(binding = 6) uniform sampler2D near_coarse;  // of a quarter of the picture

flat in vec4 tile;

layout(location = 0) out vec4 color;

// Share of a pixel that is neither far before nor behind the focus.
float slight_share(float diameter) {
    return clamp(kBlurriest - abs(diameter), 0.0, 1.0);
}

#ifdef SLIGHT

// Small circles, pixel by pixel, as focus_gather.frag does large ones; with what they cover. None is wider here than
// `reach`.
vec4 slightly_blurred(ivec2 here, float own, float reach) {
    ivec2 last = ivec2(focus.size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < kSlightTaps && focus.pixel[i].z < reach + 0.5; ++i) {
        vec4 seen = texelFetch(seen_pixels, clamp(here + ivec2(focus.pixel[i].xy), ivec2(0), last), 0);
        float radius = min(abs(seen.a), seen.a > own ? abs(own) : 0.5 * kBlurriest);
        int place = int(float(kSlightStep) * min(radius, 0.5 * kBlurriest) + 0.5);
        float covered = clamp(float(place) / float(kSlightStep) + 0.5 - focus.pixel[i].z, 0.0, 1.0);
        float weight = covered * focus.area[place >> 2][place & 3] * slight_share(2.0 * seen.a);
        sum += weight * vec4(seen.rgb, 1.0);
    }
    return sum;
}

#endif

#ifdef BLURRED

const float kOpaque = 0.97;  // of a near surface, which then hides all

// A loop is left early, a branch may not be.
vec4 texture_if(sampler2D image, vec2 uv, bool wanted) {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (wanted ? 1 : 0); ++i) {
        sum += textureLod(image, uv, 0.0);
    }
    return sum;
}

// What a near thing hides, guessed from around it: the finest level that knows.
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
    vec4 own = texelFetch(seen_pixels, here, 0);
    float share = slight_share(2.0 * own.a);
    vec4 shown = vec4(own.rgb * share, share);
#ifdef SLIGHT
    float reach = max(texelFetch(near_reach, here / kFocusBlock, 0).x, min(abs(own.a), 0.5 * kBlurriest));
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
        // Parts of one surface, of which neither hides the other; but wide circles hide slight ones.
        shown = near + max(1.0 - hidden_share, 0.0) * shown;
        near = vec4(0.0);
    }
    vec4 behind = hidden(uv, is_near > 0.0 && shown.a < kOpaque ? textureQueryLevels(behind_near) : 0);
    vec4 all = is_near > 0.0 ? shown / max(shown.a, 1e-4) : vec4(0.0);  // where nothing else is known
    behind = is_near > 0.0 ? behind + (1.0 - min(behind.a, 1.0)) * all : far;
    if (behind.a > 1e-4) {
        color.rgb = shown.rgb / max(shown.a, 1.0) + max(1.0 - shown.a, 0.0) * behind.rgb / behind.a;
    }
    color.rgb = color.rgb * (1.0 - near.a) + near.rgb;
#endif
}
