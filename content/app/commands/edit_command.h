#pragma once

#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// `limn edit`: the inspector's edits of a level, without a window.
struct EditOptions {
    std::string scene;
    std::vector<std::string> lines;  ///< edits (edit_script.h), after those of `script`
    std::string script;              ///< file with an edit per line; empty: none
    std::string out;                 ///< file of the edited level; empty: the patch is printed
};

/// Fails at the first edit that fails; then nothing is written.
[[nodiscard]] Status run_edit(const EditOptions& options);

}  // namespace limn
