// What reaches a texel of the half picture from behind the focus and from before it: each tap asks a place whether its
// circle comes as far as here, and takes its light by the area that it is spread over.
#version 450
#include "lib/focus.glsl"

layout(binding = 0) uniform sampler2D far_light;
layout(binding = 1) uniform sampler2D near_light;
layout(binding = 2) uniform sampler2D light_radii;
layout(binding = 3) uniform sampler2D far_rest;  // a quarter of the picture and levels beneath it
layout(binding = 4) uniform sampler2D near_rest;
layout(binding = 5) uniform sampler2D rest_radii;

flat in vec4 tile;

layout(location = 0) out vec4 far_blurred;   // with its share of the texel
layout(location = 1) out vec4 near_blurred;  // with its coverage

const float kRim = 1.0;        // over which a circle ends [px]
const float kNarrowest = 0.2;  // circle that taps can tell, of the widest

// Side of a texel of `level` [px].
float side_of(float level) {
    return exp2(level + 1.0);
}

float square(float x) {
    return x * x;
}

// Enough taps to miss no texel of a disc.
int taps_for(float radius, float level) {
    float texels = 3.14159265 * square(radius / side_of(level));
    return clamp(int(1.3 * texels), 8, kFocusTaps);
}

// Behind the focus: the circle of the texel itself bounds what is behind it, or that would reach before it.
vec4 gather_far(sampler2D layer, sampler2D radii, vec2 uv, float radius, float level, int first_level, int taps) {
    float widest = fitted_radius(radius, side_of(level));
    vec2 stride = widest * 0.5 / focus.size.zw;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float through = sqrt((float(i) + 0.5) / float(taps));  // radius of the aperture
        vec2 there = uv - stride * through * focus.tap[i].xy;
        vec4 light = textureLod(layer, there, level - float(first_level));
        float its = textureLod(radii, there, level - float(first_level)).x / max(light.a, 1e-5);
        its = fitted_radius(min(its, radius), side_of(level));
        // A rim is soft, but not that of the circle that the kernel is made for.
        float as_wide = clamp(10.0 * its / max(widest, 1e-5) - 9.0, 0.0, 1.0);
        float reached = clamp((its - through * widest) / kRim + 0.5 + 0.5 * as_wide, 0.0, 1.0);
        its = max(its, kNarrowest * widest);
        float area = its * its + (1.0 - as_wide) * kRim * kRim / 12.0;
        sum += light * (reached * widest * widest / max(area, 1e-5));
    }
    return sum;
}

// Before the focus: the widest circle that may come here bounds the search, for fine circles and coarse ones apart.
vec4 gather_near(sampler2D layer, sampler2D radii, vec2 uv, float reach, float level, int first_level, int taps) {
    vec2 stride = reach * 0.5 / focus.size.zw;
    float rim = kRim * kRim / (12.0 * max(reach * reach, 1e-5));  // what its rim adds to a disc's area
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float through = sqrt((float(i) + 0.5) / float(taps));
        vec2 there = uv + stride * through * focus.tap[i].xy;
        vec4 light = textureLod(layer, there, level - float(first_level));
        float its = textureLod(radii, there, level - float(first_level)).y / max(light.a, 1e-5);
        float coarse = coarse_share(its);
        float meant = first_level == 0 ? 1.0 - coarse : coarse;
        float spread = clamp(fitted_radius(its, side_of(level)) / reach, kNarrowest, 1.0);
        float reached = clamp((spread - through) * reach / kRim + 0.5, 0.0, 1.0);
        sum += light * (meant * reached / (spread * spread + rim));
    }
    return sum / float(max(taps, 1));
}

void main() {
    vec2 uv = gl_FragCoord.xy / focus.size.zw;
    ivec2 here = ivec2(gl_FragCoord.xy);

    float share = texelFetch(far_light, here, 0).a;
    float radius = share > 0.0 ? texelFetch(light_radii, here, 0).z / share : 0.0;
    bool coarse = radius > kFineRadius;
    float level = max(level_of(radius), 1.0);
    int fine_taps = share > 0.0 && !coarse ? taps_for(radius, 0.0) : 0;
    int coarse_taps = coarse ? taps_for(radius, level) : 0;
    vec4 far = gather_far(far_light, light_radii, uv, radius, 0.0, 0, fine_taps)
               + gather_far(far_rest, rest_radii, uv, radius, level, 1, coarse_taps);
    far_blurred = far.a > 1e-5 ? far * (share / far.a) : vec4(0.0);

    level = max(level_of(tile.y), 1.0);
    fine_taps = tile.x > 0.0 ? taps_for(tile.x, 0.0) : 0;
    coarse_taps = tile.y > 0.0 ? taps_for(tile.y, level) : 0;
    vec4 near = gather_near(near_light, light_radii, uv, tile.x, 0.0, 0, fine_taps)
                + gather_near(near_rest, rest_radii, uv, tile.y, level, 1, coarse_taps);
    near_blurred = near / max(near.a, 1.0);
}
