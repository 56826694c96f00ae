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

#ifdef SLIGHT

// How many of the pixels around one, nearest first, a circle of `radius` touches; none if it is large.
int taps_within(float radius) {
    int some = radius > 1.736 ? 21 : radius > 1.5 ? 13 : radius > 0.914 ? 9 : radius > 0.5 ? 5 : 0;
    return radius > 0.5 * kBlurriest ? 0 : some;
}

// Small circles, pixel by pixel, as focus_gather.frag does large ones.
vec3 slightly_blurred(ivec2 here, float own, int taps) {
    ivec2 last = ivec2(focus.size.xy) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        ivec2 offset = ivec2(focus.tap[i].zw);
        ivec2 there = clamp(here + offset, ivec2(0), last);
        float its = circle(texelFetch(scene_depth, there, 0).r);
        float radius = 0.5 * min(abs(its), its > own ? abs(own) : abs(its));
        float area = max(radius + 0.5, 3.14159265 * (radius * radius + 1.0 / 12.0));
        float covered = clamp(radius + 0.5 - length(vec2(offset)), 0.0, 1.0);
        float weight = covered / area * (1.0 - near_share(its));
        sum += weight * finite_light(texelFetch(scene_radiance, there, 0));
    }
    return sum.rgb / max(sum.a, 1e-6);
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

// mix() that forgets NaN at last.
vec3 replace(vec3 old, vec3 by, float share) {
    return share < 1.0 ? mix(old, by, share) : by;
}

#endif

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(scene_radiance, here, 0);
    color = own;
#if defined(SLIGHT) || defined(BLURRED)
    float diameter = circle(texelFetch(scene_depth, here, 0).r);
#endif
#ifdef SLIGHT
    int taps = tile.w > 1.0 ? kSlightTaps : taps_within(0.5 * abs(diameter));  // near ones reach out of their own
    color.rgb = taps > 1 ? slightly_blurred(here, diameter, taps) : own.rgb;
#endif
#ifdef BLURRED
    vec2 uv = gl_FragCoord.xy * 0.5 / focus.size.zw;
    vec4 far = texture(far_blurred, uv);
    if (far.a > 1e-4) {
        color.rgb = replace(color.rgb, far.rgb / far.a, far_share(diameter));
    }
    vec4 near = texture(near_blurred, uv);
    float is_near = near_share(diameter);
    vec4 behind = hidden(uv, is_near > 0.0 ? kHiddenLevels : 0);  // a loop is left early, a branch may not be
    if (behind.a > 1e-4) {
        color.rgb = replace(color.rgb, behind.rgb / behind.a, is_near);
    } else if (is_near > 0.0) {
        near /= max(near.a, 1e-4);  // nothing but near things around
    }
    color.rgb = color.rgb * (1.0 - near.a) + near.rgb;
#endif
}
