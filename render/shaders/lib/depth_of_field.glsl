// Circles of confusion, and the layers of pixels sorted by them.
// Techniques: post.circle-of-confusion

#include "depth_of_field_gpu.h"
#include "lib/numbers.glsl"

layout(std140, binding = kFocusBinding) uniform Focus {
    FocusBlock focus;
};

// Diameter [px] of a point's circle of confusion, negative in front of the focus (post.circle-of-confusion). Linear
// in reversed depth, which is 0 at infinity.
float circle(float depth) {
    float diameter = focus.lens.x * (focus.lens.y - depth * focus.lens.z);
    return clamp(diameter, -focus.lens.w, focus.lens.w);
}

// Weight of a pixel in the far or near layer, which are blurred at half resolution.
float far_weight(float diameter) {
    return clamp((diameter - kFullResDiameter) / (kHalfResDiameter - kFullResDiameter), 0.0, 1.0);
}
float near_weight(float diameter) {
    return far_weight(-diameter);
}

// Weight with which a circle of `radius` [px] is gathered coarsely, from a lower mip level.
float coarse_weight(float radius) {
    return clamp(radius - kFineRadius + 0.5, 0.0, 1.0);
}

// The mip level at which taps over circles of `radius` [px] leave no gaps; 0 is half resolution.
float level_of(float radius) {
    return min(ceil(log2(max(radius / kLevelRadius, 1.0))), float(focus.tiles.w));
}

// Radius of the scaled aperture whose rim passes through `point`: 1 for the unit aperture, whatever its shape.
float aperture_radius(vec2 point) {
    if (focus.aperture.x < 3.0) {
        return length(point);
    }
    float slice = 6.28318531 / focus.aperture.x;
    float angle = atan(point.y, point.x) - focus.aperture.y;
    float from_center = angle - (floor(angle / slice) + 0.5) * slice;
    return length(point) * cos(from_center) / cos(0.5 * slice);
}

// Stored as the radius of a pixel with non-finite radiance, which is ignored.
const float kUnknown = 32768.0;

// Kernel radius at half resolution [texels], and 1 / the texels that it covers, for discs of `radius` [px]: narrower
// by the tents of down- and upsampling, which blur too (variances add).
vec2 kernel_of(float radius) {
    float index = float(kKernelStep) * radius;
    int i = clamp(int(index), 0, kKernels - 2);
    vec4 low = focus.kernel[i >> 1];
    vec4 high = focus.kernel[(i + 1) >> 1];
    bool odd = (i & 1) != 0;
    return mix(odd ? low.zw : low.xy, odd ? high.xy : high.zw, index - float(i));
}

// 1 for a circle or kernel clearly smaller than `own`: behind the focus it is in front of `own`, in front of the focus
// behind it. 0 if both are in the same layer.
float front_weight(float circle, float own) {
    return clamp((own - circle) / (0.1 * own + 0.1) - 1.0, 0.0, 1.0);  // by eye
}

// Radiance with weight 1; all 0 for NaN and infinity.
vec4 finite_light(vec4 light) {
    return is_finite(light.rgb) ? vec4(light.rgb, 1.0) : vec4(0.0);
}

float luminance_of(vec3 light) {
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

// Weight for averaging circles, by luminance: otherwise a lamp in front of a dark sky would get a mixture of both.
float radius_weight(vec4 light) {
    return luminance_of(light.rgb) + 1e-6 * light.a;
}
