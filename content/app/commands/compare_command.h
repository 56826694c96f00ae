#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

// Shown by `limn compare a.png b.png`: fakephong.metric-color

/// `limn compare`: compares two images of equal size.
struct CompareOptions {
    std::string a;
    std::string b;
    std::string diff;   ///< PNG of the difference; empty = none
    bool json = false;  ///< print JSON instead of a table
};

[[nodiscard]] Status run_compare(const CompareOptions& options);

}  // namespace limn
