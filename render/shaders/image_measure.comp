// Stage 2 of image statistics: one group reduces the parts, then updates eye adaptation (hdr.pipeline) and the
// exposure (hdr.key-scale).
//   HISTOGRAM  also finds the clipped range, and clears the histogram for the next frame
// Techniques: hdr.dynamic-range, hdr.key-scale
#version 450
#include "tone_gpu.h"

layout(local_size_x = 256) in;

layout(std430, binding = kStatisticsPartsBinding) readonly buffer Parts {
    StatisticsPart parts[];
};
layout(std430, binding = kHistogramBinding) buffer Histogram {
    uint histogram[];
};
layout(std430, binding = kStatisticsBinding) buffer Measure {
    ImageStatistics measure;
};

uniform int part_count;
uniform float log_delta;         // the average of black
uniform float key;               // log-average after metering; 0: no metering
uniform float adaptation_blend;  // adaptation step toward this frame's luminance, 0 .. 1
uniform vec2 adaptation_range;   // luminance range of adaptation
uniform float clipped_fraction;  // of the pixels at either end of the histogram

shared StatisticsPart joined[256];

StatisticsPart join(StatisticsPart a, StatisticsPart b) {
    return StatisticsPart(
        a.sum + b.sum, min(a.least, b.least), max(a.largest, b.largest), a.finite + b.finite, a.broken + b.broken);
}

#ifdef HISTOGRAM
float bin_edge(int bin) {
    return exp2(kHistogramLow + float(bin) / kBinsPerStop);
}

// The range without `clipped_fraction` of the pixels above 0 at either end, to the precision of a bin.
vec2 clipped_range(float smallest, float largest) {
    uint lit = 0u;
    for (int i = 0; i < kHistogramBins; ++i) {
        lit += histogram[i];
    }
    uint outside = uint(clipped_fraction * float(lit));
    uint below = 0u;
    int low = 0;
    while (low < kHistogramBins - 1 && below + histogram[low] <= outside) {
        below += histogram[low++];
    }
    uint above = 0u;
    int high = kHistogramBins - 1;
    while (high > 0 && above + histogram[high] <= outside) {
        above += histogram[high--];
    }
    return vec2(max(bin_edge(low), smallest), min(bin_edge(high + 1), largest));
}
#endif

void main() {
    uint i = gl_LocalInvocationIndex;
    StatisticsPart mine = StatisticsPart(vec4(0.0), kNoLuminance, 0.0, 0u, 0u);
    for (uint k = i; k < uint(part_count); k += 256u) {
        mine = join(mine, parts[k]);
    }
    joined[i] = mine;
    for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
        barrier();
        if (i < half_count) {
            joined[i] = join(joined[i], joined[i + half_count]);
        }
    }
    if (i != 0u) {
        return;
    }

    StatisticsPart all = joined[0];
    float count = max(float(all.finite), 1.0);
    // Without any finite pixel the image counts as black.
    float average = all.finite > 0u ? exp2(all.sum.w / count) : log_delta;
    float least = all.largest > 0.0 ? all.least : 0.0;
    bool adapted_before = measure.pixels.w != 0u;
    float adapted = measure.luminance.y;
    adapted = adapted_before ? adapted + (average - adapted) * adaptation_blend : average;
    // Exactly this frame's for a full step, so that history leaves no rounding error.
    adapted = adaptation_blend >= 1.0 ? average : adapted;

    measure.mean_scale = vec4(all.sum.rgb / count, key > 0.0 ? key / clamp(adapted, adaptation_range.x, adaptation_range.y) : 1.0);
    measure.luminance = vec4(average, adapted, least, all.largest);
    measure.clipped = vec4(least, all.largest, 0.0, 0.0);
    measure.pixels = uvec4(all.finite, all.broken, 0u, 1u);
#ifdef HISTOGRAM
    measure.clipped.xy = clipped_range(least, all.largest);
    for (int bin = 0; bin < kHistogramBins; ++bin) {
        histogram[bin] = 0u;
    }
#endif
}
