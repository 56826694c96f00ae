#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn quality`: effects against their oracles.
struct QualityOptions {
    std::string effect;  ///< empty = all
    std::string json;    ///< file to write; empty = none
    std::string html;    ///< file to write; empty = none
};

/// Prints the table; fails if a bound is not kept, after everything is written.
[[nodiscard]] Status run_quality(const QualityOptions& options);

}  // namespace limn
