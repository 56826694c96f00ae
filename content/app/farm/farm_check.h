#pragma once

#include "content/app/farm/farm_job.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// What is wrong with a frame's file.
struct FrameProblem {
    int frame = 0;
    bool missing = false;  ///< no file, or no state that says it is done; else it is damaged
    std::string what;      ///< one line
};

/// Decodes every frame, on all threads, and compares its hash with the one in its state. By frame;
/// none: all are whole.
[[nodiscard]] std::vector<FrameProblem> check_frames(const FarmJob& job);

/// `limn farm check`: prints what is wrong and how second renderings compare. Fails unless all
/// frames are whole and no rendering differs where it must not.
[[nodiscard]] Status run_farm_check(const std::string& folder, bool json);

}  // namespace limn
