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

// Beside the light of a pixel that is not finite, in place of its circle: it is nobody's.
const float kUnknown = 32768.0;

// Kernel in the half picture [texels], and 1 / the texels that it covers, whose disc is as wide as one of `radius` [px]
// once the tents of splitting and of showing half as many pixels have blurred it: variances add.
vec2 kernel_of(float radius) {
    float place = float(kKernelStep) * radius;
    int i = clamp(int(place), 0, kKernels - 2);
    vec4 low = focus.kernel[i >> 1];
    vec4 high = focus.kernel[(i + 1) >> 1];
    bool odd = (i & 1) != 0;
    return mix(odd ? low.zw : low.xy, odd ? high.xy : high.zw, place - float(i));
}

// Share of what has a circle or kernel that is clearly less than `own`: behind the focus it lies before that, before the
// focus behind it; else they are beside each other.
float before(float circle, float own) {
    return clamp((own - circle) / (0.1 * own + 0.1) - 1.0, 0.0, 1.0);  // by eye
}

// Light with a 1 beside it; NaN and infinity are nobody's light.
vec4 finite_light(vec4 light) {
    return max(light.r, max(light.g, light.b)) <= 3e38 ? vec4(light.rgb, 1.0) : vec4(0.0);
}

float luminance_of(vec3 light) {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

// Of neighbors that are mixed the one that shines most decides about the circle: else a lamp before the night gets one
// of both.
float radius_weight(vec4 light) {
    return luminance_of(light.rgb) + 1e-6 * light.a;
}
