#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

/// Curves with one row of `channels` values per sample, at uniform times.
struct SampledCurves {
    float rate = 60.0f;  ///< samples per second
    std::size_t channels = 0;
    std::vector<float> values;  ///< row i at time i / rate

    [[nodiscard]] std::size_t size() const { return channels == 0 ? 0 : values.size() / channels; }
    [[nodiscard]] std::span<const float> row(std::size_t i) const {
        return std::span(values).subspan(i * channels, channels);
    }
};

/// Interpolates curves through their samples by radial basis functions r^3 with a linear part
/// (face.align-resample). In one dimension that is the natural cubic spline, which takes O(n) for n
/// samples instead of the O(n^3) of a dense system. Before the first and after the last sample the
/// curve is extrapolated linearly.
class CurveSpline {
  public:
    explicit CurveSpline(const SampledCurves& curves);

    /// Writes the values at `time` [s], one per channel.
    void evaluate(float time, std::span<float> values) const;

  private:
    SampledCurves curves_;
    std::vector<double> bends_;  ///< second derivative by sample index, laid out as the values
};

/// Maps the time `t` in the target to the source: linear between the boundaries, which increase and
/// are equally many, at least two; beyond them at the rate of the nearest interval.
[[nodiscard]] float map_time(std::span<const float> target, std::span<const float> source, float t);

/// Weight of the later of two curves that overlap, at s = 0 .. 1 through the overlap
/// (face.fragment-blend): 3 s^2 - 2 s^3.
[[nodiscard]] float blend_weight(float s);

}  // namespace limn
