#pragma once

#include "render/gpu/readback.h"

#include <span>
#include <vector>

namespace limn::oracle {

// What a shutter that is open for a while sees: the mean of pictures of moments within the
// exposure, each drawn sharp, and closed forms of it where the motion is even. In double precision.

/// Moment of picture `index` of `count` in an exposure that lasts shutter / 360 and is centered on
/// 0; 1 is the time between two pictures.
[[nodiscard]] double exposure_moment(int index, int count, double shutter);

/// The mean of pictures of equal size.
class MeanPicture {
  public:
    void add(const gpu::FloatImage& picture);
    [[nodiscard]] gpu::FloatImage mean() const;

  private:
    gpu::FloatImage shape_;
    std::vector<double> sum_;
    int count_ = 0;
};

/// A row of pixels, constant within each and going on at its ends as it is there, while it moves
/// evenly by `way` pixels in all: convolution with a box of that length, read in the middle of each
/// pixel.
[[nodiscard]] std::vector<double> box_filter(std::span<const double> row, double way);

/// Share of the exposure for which a bar from `begin` to `end` stands at `x` while it moves evenly,
/// by `way` in all and half of it before the moment for which its place is given.
[[nodiscard]] double bar_coverage(double x, double begin, double end, double way);

/// post.motion-blur-stretch of a bar that was from `begin` to `end` and went `way`: what `samples`
/// of either picture say of the point `x`. `printed`: with the signs of the listing.
[[nodiscard]] double
stretch_coverage(double x, double begin, double end, double way, int samples, bool printed = false);

}  // namespace limn::oracle
