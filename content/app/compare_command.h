#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn compare`: how different two pictures of equal size are.
struct CompareOptions {
    std::string a;
    std::string b;
    std::string diff;   ///< picture of the difference; empty = none
    bool json = false;  ///< print JSON instead of a table
};

[[nodiscard]] Status run_compare(const CompareOptions& options);

}  // namespace limn
