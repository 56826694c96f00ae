// Gathers coarse circles at quarter resolution: for taps over the aperture, tests whether the circle at the tap covers
// this texel. The wider the circles, the coarser the mip level of the taps, so that they leave no gaps.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusFarBaseUnit) uniform sampler2D far_base;  // with mip levels
layout(binding = kFocusNearBaseUnit) uniform sampler2D near_base;
layout(binding = kFocusBaseRadiiUnit) uniform sampler2D base_radii;
layout(binding = kFocusTilesUnit) uniform sampler2D focus_tiles;

layout(location = 0) out vec4 far_coarse;    // alpha: its weight in the texel
layout(location = 1) out vec4 near_coarse;   // alpha: coverage
layout(location = 2) out float near_radius;  // [px], times coverage

const int kCell = 4;           // side of a texel [px]
const float kNarrowest = 0.2;  // smallest circle that taps resolve, relative to the widest

// Side of a texel of `level` [px].
float side_of(float level) {
    return exp2(level + 1.0);
}

float square(float x) {
    return x * x;
}

// Width of the soft rim of a circle among taps for the `widest` [px], which are too far apart to resolve a rim of 1 px
// of a smaller one.
float rim_of(float as_wide, float widest) {
    return mix(max(0.25 * widest, 1.0), 1.0, as_wide);
}

// 1 for circles as wide as the widest, 0 for clearly smaller ones.
float is_as_wide(float radius, float widest) {
    return clamp(1.0 - (widest - radius) / max(0.1 * widest, 1.0), 0.0, 1.0);
}

// Enough taps to sample every texel of a disc.
int taps_for(float radius, float level) {
    float texels = 3.14159265 * square(radius / side_of(level));
    return clamp(int(1.3 * texels), 8, kFocusTaps);
}

// Compensates the widening of discs by the other steps of resampling: variances add. Texels have side `texel` [px].
float fitted_radius(float radius, float texel) {
    float done = 0.25 * texel * texel + 25.0 / 6.0;
    return sqrt(max(radius * radius - done / focus.aperture.w, 0.0));
}

// Light of the near layer at a point, normalized by the areas of its circles. The search radius `range` is that of
// the widest circle that may cover the point. Near discs are upside down.
vec4 gather_near(vec2 uv, float range, float level, int taps, out float radius) {
    vec2 stride = 0.25 * range / vec2(textureSize(near_base, 0));
    vec4 sum = vec4(0.0);
    radius = 0.0;
    for (int i = 0; i < taps; ++i) {
        float aperture = sqrt((float(i) + 0.5) / float(taps));  // radius of the aperture
        vec2 at = uv + stride * aperture * focus.tap[i].xy;
        vec4 light = textureLod(near_base, at, level - 1.0);
        float texel_radius = textureLod(base_radii, at, level - 1.0).y / max(radius_weight(light), 1e-20);
        float spread = clamp(fitted_radius(texel_radius, side_of(level)) / range, kNarrowest, 1.0);
        float rim = rim_of(is_as_wide(texel_radius, range), range) / range;
        float covered = clamp((spread - aperture) / rim + 0.5, 0.0, 1.0);
        light *= covered / (spread * spread + rim * rim / 12.0) / float(taps);
        sum += light;
        radius += light.a * texel_radius;
    }
    return sum;
}

// Intensity of a circle of `radius` at a tap `aperture` of a kernel of `widest`, relative to that of the widest circle.
float spread_behind(float radius, float widest, float aperture) {
    // Rims are soft, except that of the circle for which the kernel is made.
    float as_wide = is_as_wide(radius, widest);
    float rim = rim_of(as_wide, widest);
    float covered = clamp((radius - aperture * widest) / rim + 0.5 + 0.5 * as_wide, 0.0, 1.0);
    radius = max(radius, kNarrowest * widest);
    float area = radius * radius + (1.0 - as_wide) * rim * rim / 12.0;
    return covered * max(widest * widest, 0.25) / max(area, 0.25);
}

// Light of the far layer. The texel's own circle bounds those of farther texels, which would otherwise bleed over it.
vec4 gather_far(vec2 uv, float radius, float level, int taps) {
    float side = side_of(level);
    float widest = fitted_radius(radius, side);
    vec2 stride = 0.25 * widest / vec2(textureSize(far_base, 0));
    vec4 front = vec4(0.0);
    vec4 same_layer = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        float aperture = sqrt((float(i) + 0.5) / float(taps));
        vec2 at = uv - stride * aperture * focus.tap[i].xy;
        vec4 light = textureLod(far_base, at, level - 1.0);
        float texel_radius = textureLod(base_radii, at, level - 1.0).x / max(radius_weight(light), 1e-20);
        float over = front_weight(texel_radius, radius);
        light *= spread_behind(fitted_radius(min(texel_radius, radius), side), widest, aperture);
        front += over * light;
        same_layer += (1.0 - over) * light;
    }
    front /= max(front.a, float(max(taps, 1)));
    return front + (1.0 - front.a) * same_layer / max(same_layer.a, 1e-5);
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(far_base, 0));

    vec4 tile = texelFetch(focus_tiles, min(kCell * here / kFocusTile, focus.tiles.xy - 1), 0);

    // Next to far texels: the light visible past the rims of fine circles.
    vec4 own = texelFetch(far_base, here, 0);
    float edge_radius = tile.w > 0.0 ? kFineRadius : 0.0;
    float radius = own.a > 0.0 ? texelFetch(base_radii, here, 0).x / max(radius_weight(own), 1e-20) : edge_radius;
    float level = max(level_of(radius), 1.0);
    vec4 far = gather_far(uv, radius, level, radius > 0.0 ? taps_for(radius, level) : 0);
    far_coarse = far * (max(own.a, 0.01) / max(far.a, 1e-5));

    level = max(level_of(tile.y), 1.0);
    near_coarse = gather_near(uv, tile.y, level, tile.y > 0.0 ? taps_for(tile.y, level) : 0, near_radius);
}
