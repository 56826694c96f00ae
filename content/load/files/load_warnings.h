#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <span>
#include <string>

namespace limn {

// A bad part of a file is skipped with a warning, one line that names the file, the element and
// the value; the rest is loaded. Loaders collect such lines and report them here.

struct LoadOptions {
    bool strict = false;            ///< a warning is an error
    std::size_t max_warnings = 10;  ///< that are logged; the rest are counted
};

/// Logs the warnings of `file`; with `strict`, fails with them instead.
[[nodiscard]] Status report_load_warnings(
    const std::string& file, std::span<const std::string> warnings, const LoadOptions& options);

}  // namespace limn
