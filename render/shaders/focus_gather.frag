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

const float kNarrowest = 0.2;  // circle that taps can tell, of the widest

// Side of a texel of `level` [px].
float side_of(float level) {
    return exp2(level + 1.0);
}

float square(float x) {
    return x * x;
}

// Over how much a circle ends among taps for the `widest` [px]: those lie too far apart to show a rim of 1 px of one that
// is less.
float rim_of(float as_wide, float widest) {
    return mix(max(0.25 * widest, 1.0), 1.0, as_wide);
}

// 1 for circles as wide as the widest, 0 for all that are clearly less.
float is_as_wide(float radius, float widest) {
    return clamp(1.0 - (widest - radius) / max(0.1 * widest, 1.0), 0.0, 1.0);
}

// Enough taps to miss no texel of a disc.
int taps_for(float radius, float level) {
    float texels = 3.14159265 * square(radius / side_of(level));
    return clamp(int(1.3 * texels), 8, kFocusTaps);
}

// What of a layer lies over a place, by the area that its circles are spread over. The widest that may come here bounds
// the search; the level says whether fine or coarse ones are meant. Discs behind the focus are the aperture, before it
// they stand on their heads.
vec4 gather_over(
    sampler2D layer, sampler2D radii, int component, vec2 uv, float reach, float level, int first_level, bool fine,
    int taps) {
    vec2 stride = (component == 0 ? -reach : reach) * 0.5 / focus.size.zw;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float through = sqrt((float(i) + 0.5) / float(taps));  // radius of the aperture
        vec2 there = uv + stride * through * focus.tap[i].xy;
        vec4 light = textureLod(layer, there, level - float(first_level));
        float its = textureLod(radii, there, level - float(first_level))[component] / max(radius_weight(light), 1e-20);
        float coarse = coarse_share(its);
        float meant = fine ? 1.0 - coarse : coarse;
        float spread = clamp(fitted_radius(its, side_of(level)) / reach, kNarrowest, 1.0);
        float rim = rim_of(is_as_wide(its, reach), reach) / reach;
        float reached = clamp((spread - through) / rim + 0.5, 0.0, 1.0);
        sum += light * (meant * reached / (spread * spread + rim * rim / 12.0));
    }
    return sum / float(max(taps, 1));
}

// How a circle of `radius` is spread over a place that a kernel of `widest` reads at `through`, against one as wide.
float spread_behind(float radius, float widest, float through) {
    // A rim is soft, but not that of the circle that the kernel is made for.
    float as_wide = is_as_wide(radius, widest);
    float rim = rim_of(as_wide, widest);
    float reached = clamp((radius - through * widest) / rim + 0.5 + 0.5 * as_wide, 0.0, 1.0);
    radius = max(radius, kNarrowest * widest);
    float area = radius * radius + (1.0 - as_wide) * rim * rim / 12.0;
    return reached * max(widest * widest, 0.25) / max(area, 0.25);
}

// What is behind all that: the circle of the texel itself bounds what lies behind it, or that would reach before it.
// Coarse circles see none but coarse ones, the others lie over them.
vec4 gather_behind(
    sampler2D layer, sampler2D radii, vec2 uv, float radius, float level, int first_level, int taps) {
    float side = side_of(level);
    float widest = fitted_radius(radius, side);
    vec2 stride = widest * 0.5 / focus.size.zw;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float through = sqrt((float(i) + 0.5) / float(taps));
        vec2 there = uv - stride * through * focus.tap[i].xy;
        vec4 light = textureLod(layer, there, level - float(first_level));
        vec3 its = textureLod(radii, there, level - float(first_level)).xyz;
        float shines = its.x / max(radius_weight(light), 1e-20);
        float covers = first_level == 0 ? its.z / max(light.a, 1e-5) : shines;
        float meant = first_level == 0 ? 1.0 : coarse_share(shines) + 1e-4;
        sum.rgb += light.rgb * (meant * spread_behind(fitted_radius(min(shines, radius), side), widest, through));
        sum.a += light.a * (meant * spread_behind(fitted_radius(min(covers, radius), side), widest, through));
    }
    return sum;
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
    int over_taps = coarse && tile.z > 1.0 ? taps_for(tile.z, 0.0) : 0;
    vec4 far = gather_behind(far_light, light_radii, uv, radius, 0.0, 0, fine_taps)
               + gather_behind(far_rest, rest_radii, uv, radius, level, 1, coarse_taps);
    vec4 over = gather_over(far_light, light_radii, 0, uv, tile.z, 0.0, 0, true, over_taps);
    over /= max(over.a, 1.0);
    far = over + (1.0 - over.a) * far / max(far.a, 1e-5);
    far_blurred = far.a > 1e-4 ? far * (share / far.a) : vec4(0.0);

    level = max(level_of(tile.y), 1.0);
    fine_taps = tile.x > 0.0 ? taps_for(tile.x, 0.0) : 0;
    coarse_taps = tile.y > 0.0 ? taps_for(tile.y, level) : 0;
    vec4 near = gather_over(near_light, light_radii, 1, uv, tile.x, 0.0, 0, true, fine_taps)
                + gather_over(near_rest, rest_radii, 1, uv, tile.y, level, 1, false, coarse_taps);
    near_blurred = near / max(near.a, 1.0);
}
