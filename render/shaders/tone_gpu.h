// Layouts of the passes between radiance and display: the statistics of an image and the blur weights of dodging
// and burning. Shared by C++ and GLSL; std430, the blocks std140 too.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

/// Partial statistics: the pixels of one invocation.
struct StatisticsPart {
    vec4 sum;       // of color; w: of log2(luminance + kLogDelta)
    float least;    // minimum luminance above 0; kNoLuminance if there is none
    float largest;  // maximum luminance
    uint finite;    // number of pixels counted
    uint broken;    // number of pixels with NaN or infinity, which are otherwise ignored
};

/// Statistics of the whole image, and the exposure derived from them.
struct ImageStatistics {
    vec4 mean_scale;  // mean color; w: exposure factor besides 2^ev
    vec4 luminance;   // log-average; adapted log-average; minimum above 0; maximum
    vec4 clipped;     // minimum and maximum luminance without the outliers of the histogram, if there is one
    uvec4 pixels;     // finite; broken; w: 1 once there is an adapted luminance
};

/// Blur weights by distance [texels of the target], one blur per component.
struct BlurWeights {
    vec4 weight[16];
};

const float kLogDelta = 1e-4f;       // keeps the logarithm of black finite; less where metering goes lower
const float kNoLuminance = 1e9;      // more than any luminance
const float kMaxHalf = 65504.0;    // the largest half; brighter light is clamped to it
const int kHistogramBins = 1024;     // of log2 luminance, from the smallest half to 2^16
const float kHistogramLow = -24.0;
const float kBinsPerStop = 25.6f;
const uint kSurfaceWeight = 256u;    // of a pixel with a surface, where one without counts 1
const int kStatisticsTile = 64;      // side of the tile that one work group of stage 1 sums up [px]
const int kStatisticsGroup = 8;      // side of that group [invocations]

// Bindings.
const uint kBlurWeightsBinding = 2u;
const uint kToneMeasureBinding = 2u;
const uint kLocalFineUnit = 1u;
const uint kLocalMediumUnit = 2u;
const uint kLocalCoarseUnit = 3u;
const uint kStatisticsDepthUnit = 1u;
const uint kStatisticsPartsBinding = 0u;
const uint kHistogramBinding = 1u;
const uint kStatisticsBinding = 2u;

#ifdef __cplusplus
static_assert(sizeof(StatisticsPart) == 32);
static_assert(sizeof(ImageStatistics) == 64);
static_assert(sizeof(BlurWeights) == 256);
}  // namespace limn::layout
#endif
