// One axis of a step between two levels of the pyramid. Down: smooths, applies the tent and smooths again; up: the
// transpose of the first two. Definitions UP; TWICE: along the axis the larger image has exactly twice as many texels, and
// the source at least five.
#version 450
#include "lib/pyramid.glsl"
#include "fullscreen_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D source;

uniform ivec2 axis;  // (1, 0) or (0, 1)
uniform int sizes;   // texels of the target along it
uniform float gain;

layout(location = 0) out vec4 stepped;

#ifdef TWICE
// The weights below, which are the same for all texels; for texels of the larger image.
const float kDownWeights[5] = float[](26.0 / 128.0, 20.0 / 128.0, 12.0 / 128.0, 5.0 / 128.0, 1.0 / 128.0);
const float kUpWeights[3] = float[](5.0 / 16.0, 10.0 / 16.0, 1.0 / 16.0);  // of an even texel
#endif

vec3 source_at(ivec2 across, int at, int count) {
#ifdef TWICE
    at = at < 0 ? -1 - at : at < count ? at : 2 * count - 1 - at;
#else
    at = mirrored(at, count);
#endif
    return texelFetch(source, across + axis * at, 0).rgb;
}

void main() {
    ivec2 target = ivec2(gl_FragCoord.xy);
    int at = target.x * axis.x + target.y * axis.y;
    ivec2 source_size = textureSize(source, 0);
    int count = source_size.x * axis.x + source_size.y * axis.y;
    ivec2 across = target * (1 - axis);
    vec3 sum = vec3(0.0);
#if defined(TWICE) && defined(UP)
    int toward = 1 - 2 * (at & 1);
    for (int i = 0; i < 3; ++i) {
        sum += kUpWeights[i] * source_at(across, (at >> 1) + (i - 1) * toward, count);
    }
#elif defined(TWICE)
    for (int i = 0; i < 5; ++i) {
        sum += kDownWeights[i]
               * (source_at(across, 2 * at - i, count) + source_at(across, 2 * at + 1 + i, count));
    }
#elif defined(UP)
    float ratio = float(sizes) / float(count);
    int begin = int(ceil((float(at) - 1.0) / ratio - 1.5));
    for (int i = begin; i < begin + 5; ++i) {
        float weight = ratio * smooth_fraction(float(at), (float(i) + 0.5) * ratio, ratio);
        sum += weight * source_at(across, i, count);
    }
#else
    float ratio = float(count) / float(sizes);
    float center = (float(at) + 0.5) * ratio;
    int begin = int(floor(center - 2.0 * ratio)) - 1;
    for (int i = begin; i < begin + 11; ++i) {
        float weight = 0.5 * smooth_fraction(float(i), center, ratio)
                      + 0.25 * smooth_fraction(float(i), center - ratio, ratio)
                      + 0.25 * smooth_fraction(float(i), center + ratio, ratio);
        sum += weight * source_at(across, i, count);
    }
#endif
    stepped = vec4(gain * sum, 0.0);
}
