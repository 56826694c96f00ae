// Stage 1 of image statistics: every invocation sums up 64 pixels in a fixed order, neighboring invocations read
// neighboring pixels. Needs no barrier, which is expensive on a software OpenGL.
//   SURFACES   pixels without a surface get a tiny weight, so that they count only if there are no others
//   HISTOGRAM  also counts luminances, in integers, which do not depend on the order
// Techniques: hdr.dynamic-range, hdr.log-average
#version 450
#include "lib/tone.glsl"
#include "tone_gpu.h"
#include "fullscreen_gpu.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(binding = kSourceUnit) uniform sampler2D image;
#ifdef SURFACES
layout(binding = kStatisticsDepthUnit) uniform sampler2D depth;
#endif
uniform float log_delta;  // keeps the logarithm of black finite
layout(std430, binding = kStatisticsPartsBinding) writeonly buffer Parts {
    StatisticsPart parts[];
};
#ifdef HISTOGRAM
layout(std430, binding = kHistogramBinding) buffer Histogram {
    uint histogram[];
};

void count(float l) {
    int bin = int(floor((log2(l) - kHistogramLow) * kBinsPerStop));
    atomicAdd(histogram[clamp(bin, 0, kHistogramBins - 1)], 1u);
}
#endif

void main() {
    ivec2 size = textureSize(image, 0);
    ivec2 tile = ivec2(gl_WorkGroupID.xy) * kStatisticsTile;
    ivec2 begin = tile + ivec2(gl_LocalInvocationID.xy);
    ivec2 end = min(tile + kStatisticsTile, size);
    StatisticsPart part = StatisticsPart(vec4(0.0), kNoLuminance, 0.0, 0u, 0u);
    for (int y = begin.y; y < end.y; y += kStatisticsGroup) {
        for (int x = begin.x; x < end.x; x += kStatisticsGroup) {
            vec3 light = texelFetch(image, ivec2(x, y), 0).rgb;
            if (!is_finite(light)) {
                ++part.broken;
                continue;
            }
            light = clamp(light, 0.0, kMaxHalf);
            float l = luminance(light);
#ifdef SURFACES
            uint weight = texelFetch(depth, ivec2(x, y), 0).r > 0.0 ? kSurfaceWeight : 1u;
#else
            const uint weight = 1u;
#endif
            part.sum += float(weight) * vec4(light, log2(log_delta + l));
            part.largest = max(part.largest, l);
            part.least = l > 0.0 ? min(part.least, l) : part.least;
            part.finite += weight;
#ifdef HISTOGRAM
            if (l > 0.0) {
                count(l);
            }
#endif
        }
    }
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    parts[group * uint(kStatisticsGroup * kStatisticsGroup) + gl_LocalInvocationIndex] = part;
}
