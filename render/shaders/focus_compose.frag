// The picture through the lens: sharp and slightly blurred from itself, far behind the focus from the half picture,
// and over that what stands far before it.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D scene_radiance;
layout(binding = 1) uniform sampler2D scene_depth;
layout(binding = 2) uniform sampler2D far_blurred;
layout(binding = 3) uniform sampler2D near_blurred;
layout(binding = 4) uniform sampler2D behind_near;

flat in vec4 tile;

layout(location = 0) out vec4 color;

// Share of a pixel that is neither far before nor behind the focus.
float slight_share(float diameter) {
    return clamp(kBlurriest - abs(diameter), 0.0, 1.0);
}

#ifdef SLIGHT

// How many of the pixels around one, nearest first, a circle of `radius` touches.
int taps_within(float radius) {
    return radius > 2.662 ? 37 : radius > 2.5 ? 29 : radius > 2.328 ? 25 : radius > 1.736 ? 21 : radius > 1.5 ? 13
         : radius > 0.914 ? 9 : radius > 0.5 ? 5 : 1;
}

// How much those cover of the pixels around, all in all.
float pixels_in(float radius) {
    float place = min(16.0 * radius, 50.0);
    int i = int(place);
    return mix(focus.area[i >> 2][i & 3], focus.area[(i + 1) >> 2][(i + 1) & 3], place - float(i));
}

// Small circles, pixel by pixel, as focus_gather.frag does large ones; with what they cover.
vec4 slightly_blurred(ivec2 here, float own, int taps) {
    ivec2 last = ivec2(focus.size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        ivec2 offset = ivec2(focus.tap[i].zw);
        ivec2 there = clamp(here + offset, ivec2(0), last);
        float its = circle(texelFetch(scene_depth, there, 0).r);
        float radius = 0.5 * min(abs(its), its > own ? abs(own) : abs(its));
        float covered = clamp(radius + 0.5 - length(vec2(offset)), 0.0, 1.0);
        float weight = covered / pixels_in(radius) * slight_share(its);
        sum += weight * finite_light(texelFetch(scene_radiance, there, 0));
    }
    return sum;
}

#endif

#ifdef BLURRED

const int kHiddenLevels = 5;

// What a near thing hides, guessed from around it: the finest level that knows.
vec4 hidden(vec2 uv, int levels) {
    vec4 known = vec4(0.0);
    for (int level = 0; level < levels; ++level) {
        vec4 more = textureLod(behind_near, uv, float(level));
        known += (1.0 - known.a) * more * (min(4.0 * more.a, 1.0) / max(more.a, 1e-5));
    }
    return known;
}

#endif

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(scene_radiance, here, 0);
    color = own;
#if defined(SLIGHT) || defined(BLURRED)
    float diameter = circle(texelFetch(scene_depth, here, 0).r);
    float share = slight_share(diameter);
    vec4 slight = share > 0.0 ? vec4(own.rgb * share, share) : vec4(0.0);
#ifdef SLIGHT
    int taps = taps_within(max(share > 0.0 ? 0.5 * abs(diameter) : 0.0, tile.w));
    slight = taps > 1 ? slightly_blurred(here, diameter, taps) : slight;
#endif
    color.rgb = slight.a > 1e-4 ? slight.rgb / slight.a : own.rgb;
#endif
#ifdef BLURRED
    vec2 uv = gl_FragCoord.xy * 0.5 / focus.size.zw;
    vec4 far = texture(far_blurred, uv);
    vec4 near = texture(near_blurred, uv);
    float is_near = near_share(diameter);
    if (is_near > 0.0) {
        slight.a += near.a;  // parts of one surface: neither hides the other
        slight.rgb += near.rgb;
        near = vec4(0.0);
    }
    vec4 behind = hidden(uv, is_near > 0.0 ? kHiddenLevels : 0);  // a loop is left early, a branch may not be
    behind = is_near > 0.0 ? behind : far;
    if (behind.a > 1e-4) {
        color.rgb = slight.rgb / max(slight.a, 1.0) + max(1.0 - slight.a, 0.0) * behind.rgb / behind.a;
    } else if (is_near > 0.0) {
        color.rgb = slight.rgb / max(slight.a, 1e-4);  // nothing but near things around
    }
    color.rgb = color.rgb * (1.0 - near.a) + near.rgb;
#endif
}
