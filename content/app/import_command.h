#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

struct ImportOptions {
    std::string kind;  ///< ict-facekit or makehuman
    std::string in;    ///< folder
    std::string out;   ///< .glb
};

/// `limn import`: outside data into a .glb, which appears complete or not at all. Progress on a
/// terminal; then a line on what is in the file.
[[nodiscard]] Status run_import(const ImportOptions& options);

}  // namespace limn
