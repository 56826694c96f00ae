// What the passes between radiance and display share: the statistics of a picture and the weights of the blurs
// that dodge and burn. C++ and GLSL read the same text; std430, the blocks std140 too.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

/// Of the pixels of one invocation.
struct StatisticsPart {
    vec4 sum;       // mean color times pixels; w: log2 of luminance + kLogDelta, summed
    float least;    // luminance of a pixel that has any; kNoLuminance if none has
    float largest;  // luminance
    uint finite;    // pixels counted
    uint broken;    // pixels with NaN or infinity in them, in nothing else here
};

/// Of the whole picture, and what follows from it.
struct PictureMeasure {
    vec4 mean_scale;  // mean color; w: by which exposure multiplies besides 2^ev
    vec4 luminance;   // log-average; the same as adapted to; least that is not 0; largest
    vec4 clipped;     // least and largest luminance without the outermost of a histogram, if one was made
    uvec4 pixels;     // finite; broken; w: 1 once there is something adapted to
};

/// Weights of a blur by distance [texels of the target], one blur a component.
struct BlurWeights {
    vec4 weight[16];
};

const float kLogDelta = 1e-4f;       // keeps the logarithm of black finite
const float kNoLuminance = 1e9;      // more than any luminance
const float kMostLight = 65504.0;    // the largest half: what is brighter counts as this
const int kHistogramBins = 1024;     // of log2 luminance, from the least half to 2^16
const float kHistogramLow = -24.0;
const float kBinsPerStop = 25.6f;
const int kStatisticsTile = 64;      // side of what one group of stage 1 sums up [px], an invocation's share each
const int kStatisticsGroup = 8;      // side of that group

#ifdef __cplusplus
static_assert(sizeof(StatisticsPart) == 32);
static_assert(sizeof(PictureMeasure) == 64);
static_assert(sizeof(BlurWeights) == 256);
}  // namespace limn::layout
#endif
