#include "render/gpu/gpu_timer.h"

#include "ecs/base/check.h"

namespace limn::gpu {

void GpuTimer::begin_frame() {
    skip_ = frames_[static_cast<std::size_t>(writing_)].pending;
    if (!skip_) {
        frames_[static_cast<std::size_t>(writing_)].tags.clear();
    }
}

void GpuTimer::mark(std::uint32_t tag) {
    if (skip_) {
        return;
    }
    Frame& frame = frames_[static_cast<std::size_t>(writing_)];
    if (frame.tags.size() == frame.queries.size()) {
        frame.queries.emplace_back("timestamp", GL_TIMESTAMP);
    }
    frame.queries[frame.tags.size()].timestamp();
    frame.tags.push_back(tag);
}

void GpuTimer::end_frame() {
    if (skip_) {
        return;
    }
    skip_ = true;
    Frame& frame = frames_[static_cast<std::size_t>(writing_)];
    if (!frame.tags.empty()) {
        frame.pending = true;
        writing_ = (writing_ + 1) % kFrames;
    }
}

std::span<const GpuTimer::Mark> GpuTimer::take(bool wait) {
    Frame& frame = frames_[static_cast<std::size_t>(reading_)];
    if (!frame.pending) {
        return {};
    }
    // Timestamps become available in order: if the last one is, all are.
    if (!wait && !frame.queries[frame.tags.size() - 1].poll()) {
        return {};
    }
    taken_.clear();
    for (std::size_t i = 0; i < frame.tags.size(); ++i) {
        taken_.push_back({frame.tags[i], frame.queries[i].wait()});
    }
    frame.pending = false;
    reading_ = (reading_ + 1) % kFrames;
    return taken_;
}

}  // namespace limn::gpu
