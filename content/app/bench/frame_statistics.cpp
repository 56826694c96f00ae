#include "content/app/bench/frame_statistics.h"

#include "ecs/base/check.h"

#include <algorithm>

namespace limn {
namespace {

/// Reorders `samples`.
Summary summarize_in_place(std::span<double> samples) {
    if (samples.empty()) {
        return {};
    }
    std::sort(samples.begin(), samples.end());
    const std::size_t count = samples.size();
    const std::size_t rank95 = (count * 95 + 99) / 100;  // ceil(0.95 count), counted from 1
    return {
        .median = 0.5 * (samples[(count - 1) / 2] + samples[count / 2]),
        .p95 = samples[rank95 - 1],
        .max = samples.back()};
}

}  // namespace

Summary summarize(std::span<const double> samples) {
    std::vector<double> copy(samples.begin(), samples.end());
    return summarize_in_place(copy);
}

void FrameHistory::add(double sample) {
    LIMN_CHECK(!ring_.empty());
    if (size_ < ring_.size()) {
        ring_[(begin_ + size_++) % ring_.size()] = sample;
    } else {
        ring_[begin_] = sample;
        begin_ = (begin_ + 1) % ring_.size();
    }
}

Summary FrameHistory::summary() {
    for (std::size_t i = 0; i < size_; ++i) {
        scratch_[i] = sample(i);
    }
    return summarize_in_place({scratch_.data(), size_});
}

}  // namespace limn
