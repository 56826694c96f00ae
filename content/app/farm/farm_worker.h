#pragma once

#include "content/app/farm/farm_state.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

// What runs on a node: `limn farm work JOB`. It checks that program and inputs are the job's,
// claims its frames, and lets a second process draw them, so that nothing that one frame does - a
// crash, a hang, too much memory - loses what is known. An image counts when this process has
// decoded it.

/// Exit statuses of `limn farm work` besides 0 (nothing of the chunk is left to do) and 1.
inline constexpr int kTryElsewhere = 75;  ///< frames are left, or this node is left out

struct FarmWork {
    std::string job;                    ///< folder
    std::vector<int> frames;            ///< the chunk
    StateFile kind = StateFile::Frame;  ///< Verify: draws them a second time, keeps no image
};

/// Renders what is missing of the chunk. Returns the exit status; prints what it did to stdout, a
/// line a frame.
[[nodiscard]] Result<int> run_farm_work(const FarmWork& work);

/// The second process: draws frames, and prints a line as each begins, as it lives, and as each is
/// written. `prefix` is where files go until they are decoded.
[[nodiscard]] Status
draw_farm_frames(const std::string& job, const std::vector<int>& frames, const std::string& prefix);

}  // namespace limn
