#pragma once

#include "render/gpu/readback.h"

#include <span>
#include <vector>

namespace limn::oracle {

// Motion blur in double precision: the mean of sharp images at times within the exposure, and
// closed forms for uniform motion.

/// Time of sample `index` of `count` in an exposure of length shutter / 360, centered on 0;
/// `shutter` in degrees, 1 is the time between frames.
[[nodiscard]] double exposure_sample_time(int index, int count, double shutter);

/// The mean of images of equal size.
class MeanImage {
  public:
    void add(const gpu::FloatImage& image);
    [[nodiscard]] gpu::FloatImage mean() const;

  private:
    gpu::FloatImage shape_;
    std::vector<double> sum_;
    int count_ = 0;
};

/// A row of pixels, constant within each and clamped at its ends, that moves uniformly by
/// `distance` pixels in total: convolution with a box of that length, sampled at the pixel centers.
[[nodiscard]] std::vector<double> box_filter(std::span<const double> row, double distance);

/// Fraction of the exposure for which a bar from `begin` to `end` covers `x` while it moves
/// uniformly by `distance` in total; its position is given at the center of the exposure.
[[nodiscard]] double bar_coverage(double x, double begin, double end, double distance);

/// post.motion-blur-stretch of a bar of pixels previously from `begin` to `end` that moved by
/// `distance`: the mean at `x` of `samples` of each image, linearly filtered; 0 beyond the path of
/// the bar.
[[nodiscard]] double
stretch_coverage(double x, double begin, double end, double distance, int samples);

}  // namespace limn::oracle
