// How strong wrinkles are where skin is compressed, as systems/faces computes it (wrinkle.compression.*).
// Techniques: face.strain, face.wrinkle-options, wrinkle.compression.alpha-directional,
//     wrinkle.compression.alpha-shading, wrinkle.compression.intensity,
//     wrinkle.compression.normal-fit, wrinkle.compression.overlap

#include "wrinkle_gpu.h"

// Intensity from the squared length ratio to rest.
float wrinkle_intensity(float ratio, float lambda, float beta) {
    return -tanh(clamp(0.5 * beta * log(max(lambda * ratio, 1e-30)), -20.0, 20.0));
}

// The lower eigenvalue of the tensor with these squared lengths along u, v and (u + v) / sqrt(2).
float shortest_ratio(float along_u, float along_v, float between) {
    float mean = 0.5 * (along_u + along_v);
    float half_difference = 0.5 * (along_u - along_v);
    float uv = between - mean;
    return max(mean - sqrt(half_difference * half_difference + uv * uv), 0.0);
}

// The strain sqrt(C) - I as (tt, bb, tb), in axes rotated by `angle` from u towards v; `side` -1 flips the second.
vec3 strain_of_tensor(float along_u, float along_v, float between, float angle, float side) {
    float mean = 0.5 * (along_u + along_v);
    float half_difference = 0.5 * (along_u - along_v);
    float uv = between - mean;
    float root = sqrt(max(along_u * along_v - uv * uv, 0.0));
    float sum = sqrt(max(2.0 * mean + 2.0 * root, 1e-20));
    float c = cos(2.0 * angle);
    float s = sin(2.0 * angle);
    float turned = half_difference * c + uv * s;
    return vec3(vec2(mean + turned, mean - turned) + root, side * (uv * c - half_difference * s)) / sum - vec3(1.0, 1.0, 0.0);
}

// Principal values of a strain (tt, bb, tb), the lower one first, and the direction of that one.
vec4 principal_strain(vec3 strain) {
    float mean = 0.5 * (strain.x + strain.y);
    float half_difference = 0.5 * (strain.x - strain.y);
    float radius = sqrt(half_difference * half_difference + strain.z * strain.z);
    float angle = radius > 1e-6 ? 0.5 * atan(-strain.z, -half_difference) : 0.0;
    return vec4(mean - radius, mean + radius, cos(angle), sin(angle));
}

const float kFullStrain = 0.3;  // strain with the full color

// Red for the largest compression of skin in any direction, blue for its stretch.
vec3 strain_color(vec4 principal) {
    float compressed = clamp(-principal.x / kFullStrain, 0.0, 1.0);
    float stretched = clamp(principal.y / kFullStrain, 0.0, 1.0);
    vec3 color = mix(vec3(0.55), vec3(0.75, 0.06, 0.02), compressed);
    return mix(color, vec3(0.03, 0.12, 0.75), stretched * (1.0 - 0.5 * compressed));
}

// Coverage by a cross of a pixel at `from_center` [px] in its cell: arms along `direction` (length by the lower value)
// and `other` [px at full strain].
vec2 strain_cross(vec2 from_center, vec4 principal, vec2 direction, vec2 other) {
    vec2 cover = vec2(0.0);
    vec2 arms[2] = vec2[2](direction, other);
    for (int i = 0; i < 2; ++i) {
        float full_length = length(arms[i]);
        vec2 along = arms[i] / max(full_length, 1e-3);
        float distance_along = abs(dot(from_center, along));
        float beside = abs(dot(from_center, vec2(-along.y, along.x)));
        float half_length = full_length * min(abs(principal[i]) / kFullStrain, 1.0);
        float inside = clamp(1.5 - beside, 0.0, 1.0) * clamp(half_length - distance_along + 0.5, 0.0, 1.0);
        cover[i] = half_length < 1.0 ? 0.0 : inside;
    }
    return cover;
}

// Squared length ratio relative to unfolded skin, for skin that has `resting` excess length.
float rested_ratio(float ratio, float resting) {
    return ratio * (1.0 - resting) * (1.0 - resting);
}

// The excess length that becomes folds, at most 1; `fraction` of the shortening folds.
float fold_excess(float ratio, float slack, float fraction) {
    float shortening = max(1.0 - sqrt(ratio) - slack, 0.0);
    return 1.0 / max(1.0 - fraction * shortening, 0.5) - 1.0;
}

// Decodes the slope of a wrinkle map. A `texel` of 128 of 255 is exactly flat.
vec2 wrinkle_slope(vec3 texel) {
    vec3 n = (texel * 255.0 - 128.0) / 127.0;
    return -n.xy / max(n.z, 0.05);
}

// Slope of the normal whose x and y are scaled and lifted to the unit sphere, which needs no normalization in hardware.
// Too flat at intermediate strengths (wrinkle.compression.normal-fit).
vec2 lifted_slope(vec2 slope, float strength) {
    vec2 xy = strength * slope * inversesqrt(1.0 + dot(slope, slope));
    return xy * inversesqrt(max(1.0 - dot(xy, xy), 0.0025));
}

// How much slopes are darkened: all of them, or only slopes that face down the map.
float wrinkle_shade(vec2 slope, bool directional) {
    return clamp(directional ? slope.y : length(slope), 0.0, 1.0);
}

// Light from the top of the map at 45 degrees, relative to light on smooth skin.
float painted_light(vec2 slope) {
    return max(1.0 - slope.y, 0.0) * inversesqrt(1.0 + dot(slope, slope));
}

// Slopes of both layers of a wrinkle map: x and y of the first normal in red and green, of the second in blue and alpha.
vec4 wrinkle_slopes(vec4 texel) {
    vec4 n = (texel * 255.0 - 128.0) / 127.0;
    vec2 z = sqrt(max(1.0 - vec2(dot(n.xy, n.xy), dot(n.zw, n.zw)), 0.0025));
    return -n / z.xxyy;
}

// The second layer blended over the first, each over flat skin, as normals: flatter at intermediate strengths.
vec2 covered_slope(vec4 slopes, vec2 strength) {
    vec3 first = vec3(-slopes.xy, 1.0) * inversesqrt(1.0 + dot(slopes.xy, slopes.xy));
    vec3 second = vec3(-slopes.zw, 1.0) * inversesqrt(1.0 + dot(slopes.zw, slopes.zw));
    vec3 n = mix(mix(vec3(0.0, 0.0, 1.0), first, strength.x), second, strength.y);
    return -n.xy / max(n.z, 0.05);
}
