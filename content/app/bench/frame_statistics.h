#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

/// Summary of a series of times.
struct Summary {
    double median = 0.0;  ///< for an even count, the mean of the two central samples
    double p95 = 0.0;     ///< smallest sample that at least 95 % of them do not exceed
    double max = 0.0;
};

/// All zero for an empty series. Order does not matter.
[[nodiscard]] Summary summarize(std::span<const double> samples);

/// Ring buffer of the last `capacity` samples, for the HUD's graph. Allocates once.
class FrameHistory {
  public:
    explicit FrameHistory(std::size_t capacity) : ring_(capacity), scratch_(capacity) {}

    void add(double sample);
    void clear() { begin_ = size_ = 0; }

    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] std::size_t capacity() const { return ring_.size(); }
    /// 0 is the oldest kept sample; i < size().
    [[nodiscard]] double sample(std::size_t i) const { return ring_[(begin_ + i) % ring_.size()]; }
    [[nodiscard]] Summary summary();

  private:
    std::vector<double> ring_;
    std::vector<double> scratch_;
    std::size_t begin_ = 0;
    std::size_t size_ = 0;
};

}  // namespace limn
