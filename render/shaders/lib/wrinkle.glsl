// How strong wrinkles are where skin is compressed, as systems/faces computes it (wrinkle.compression.*).

#include "wrinkle_gpu.h"

// Of the square of the length by that at rest.
float wrinkle_intensity(float ratio, float lambda, float beta) {
    return -tanh(clamp(0.5 * beta * log(max(lambda * ratio, 1e-30)), -20.0, 20.0));
}

// The lower eigenvalue of the tensor with these squares of lengths along u, v and (u + v) / sqrt(2).
float shortest_ratio(float along_u, float along_v, float between) {
    float mean = 0.5 * (along_u + along_v);
    float half_difference = 0.5 * (along_u - along_v);
    float uv = between - mean;
    return max(mean - sqrt(half_difference * half_difference + uv * uv), 0.0);
}

// The excess of length that becomes folds, 1 at most.
float fold_excess(float ratio, float slack, float share) {
    float shortening = max(1.0 - sqrt(ratio) - slack, 0.0);
    return 1.0 / max(1.0 - share * shortening, 0.5) - 1.0;
}

// The slope that a normal of a wrinkle map stands for. `texel` is flat at 128 of 255, exactly.
vec2 wrinkle_slope(vec3 texel) {
    vec3 n = (texel * 255.0 - 128.0) / 127.0;
    return -n.xy / max(n.z, 0.05);
}

// Slope of the normal whose x and y are scaled and lifted to the unit sphere: hardware could do it without normalizing.
// Too flat in between (wrinkle.compression.normal-fit).
vec2 lifted_slope(vec2 slope, float strength) {
    vec2 xy = strength * slope * inversesqrt(1.0 + dot(slope, slope));
    return xy * inversesqrt(max(1.0 - dot(xy, xy), 0.0025));
}

// How much darker slopes are: all, or those that face down the map.
float wrinkle_shade(vec2 slope, bool directional) {
    return clamp(directional ? slope.y : length(slope), 0.0, 1.0);
}
