#pragma once

#include "render/gpu/gpu_query.h"

#include <array>
#include <span>
#include <vector>

namespace limn::gpu {

// Timestamps of frames, read some frames later so that nothing waits. A frame marks as many points
// as it likes; its times arrive through take() when the GPU has passed them all.

class GpuTimer {
  public:
    /// Frames that may be under way; a frame beyond them is not timed rather than waited for.
    static constexpr int kFrames = 4;

    void begin_frame();
    /// The next timestamp of this frame; `tag` comes back with it.
    void mark(std::uint32_t tag);
    void end_frame();

    struct Mark {
        std::uint32_t tag;
        std::uint64_t time_ns;  ///< since some fixed moment
    };
    /// The oldest frame whose times have arrived, or nothing; `wait` waits for it. Valid until the
    /// next call.
    [[nodiscard]] std::span<const Mark> take(bool wait = false);

  private:
    struct Frame {
        std::vector<GpuQuery> queries;
        std::vector<std::uint32_t> tags;
        bool pending = false;
    };
    std::array<Frame, kFrames> frames_;
    std::vector<Mark> taken_;
    int writing_ = 0;
    int reading_ = 0;
    bool skip_ = true;  // outside a frame, or no free frame for this one
};

}  // namespace limn::gpu
