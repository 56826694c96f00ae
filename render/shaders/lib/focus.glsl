// Circles of confusion and the layers they are sorted into.

#include "focus_gpu.h"

layout(std140, binding = 2) uniform Focus {
    FocusBlock focus;
};

// Diameter [px] of a point's image, negative in front of the focus (post.circle-of-confusion). Linear in reversed
// depth, which is 0 infinitely far away.
float circle(float depth) {
    float diameter = focus.lens.x * (focus.lens.y - depth * focus.lens.z);
    return clamp(diameter, -focus.lens.w, focus.lens.w);
}

// Share of a pixel that is far behind or before the focus, and blurred at half resolution.
float far_share(float diameter) {
    return clamp((diameter - kSharpest) / (kBlurriest - kSharpest), 0.0, 1.0);
}
float near_share(float diameter) {
    return far_share(-diameter);
}

// Share of a circle of `radius` [px] that is wide enough for a coarser level to be read.
float coarse_share(float radius) {
    return clamp(radius - kFineRadius + 0.5, 0.0, 1.0);
}

// The level that taps through circles of `radius` [px] need to leave no gaps: 0 is the half picture.
float level_of(float radius) {
    return min(ceil(log2(max(radius / kLevelRadius, 1.0))), float(focus.tiles.w));
}

// Radius of the aperture that goes through `place`: 1 at the rim of the unit aperture, whatever its shape.
float aperture_radius(vec2 place) {
    if (focus.aperture.x < 3.0) {
        return length(place);
    }
    float slice = 6.28318531 / focus.aperture.x;
    float angle = atan(place.y, place.x) - focus.aperture.y;
    float from_middle = angle - (floor(angle / slice) + 0.5) * slice;
    return length(place) * cos(from_middle) / cos(0.5 * slice);
}

// Kernel whose disc, after what reading texels of side `texel` [px] and showing half as many pixels blur by
// themselves, is as wide as one of `radius` [px]: variances add.
float fitted_radius(float radius, float texel) {
    float done = 0.25 * texel * texel + 7.0 / 6.0;
    return sqrt(max(radius * radius - done / focus.aperture.w, 0.0));
}

// Light with a 1 beside it; NaN and infinity are nobody's light.
vec4 finite_light(vec4 light) {
    return max(light.r, max(light.g, light.b)) <= 3e38 ? vec4(light.rgb, 1.0) : vec4(0.0);
}

float luminance_of(vec3 light) {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

// Radii are kept times this, so that of neighbors that are mixed the one that shines most decides: else a lamp before the
// night gets circles of both.
float radius_weight(vec4 light) {
    return luminance_of(light.rgb) + 1e-6 * light.a;
}

// Mean of the 2 x 2 texels of a layer under one of half its size, of those whose circles are coarse; `mean_radius` as
// radii are kept.
vec4 coarse_mean(sampler2D layer, sampler2D radii, int component, ivec2 texel, out float mean_radius) {
    ivec2 last = textureSize(layer, 0) - 1;
    vec4 sum = vec4(0.0);
    mean_radius = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 there = min(2 * texel + ivec2(i & 1, i >> 1), last);
        vec4 light = texelFetch(layer, there, 0);
        float radius = texelFetch(radii, there, 0)[component];
        float share = 0.25 * coarse_share(radius / max(radius_weight(light), 1e-20));
        sum += share * light;
        mean_radius += share * radius;
    }
    return sum;
}
