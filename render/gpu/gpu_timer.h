#pragma once

#include "render/gpu/gpu_query.h"

#include <array>
#include <span>
#include <vector>

namespace limn::gpu {

// GPU timestamps of frames, read back some frames later so that nothing stalls. A frame may mark
// any number of points; take() returns their times once the GPU has passed them all.

class GpuTimer {
  public:
    /// Frames that may be in flight; a frame beyond them is not timed, which avoids a stall.
    static constexpr int kFrames = 4;

    void begin_frame();
    /// The next timestamp of this frame; take() returns `tag` with it.
    void mark(std::uint32_t tag);
    void end_frame();

    struct Mark {
        std::uint32_t tag;
        std::uint64_t time_ns;  ///< since an arbitrary epoch
    };
    /// The oldest frame whose times are available, or empty; `wait` blocks until they are. Valid
    /// until the next call.
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
