#pragma once

#include "content/app/commands/command_values.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

struct MakeOptions {
    std::string kind;                          ///< of mesh_kinds()
    std::string out;                           ///< .glb
    bool parts = false;                        ///< each value of its field `part` as a mesh
    std::vector<Assignment> assignments = {};  ///< FIELD=VALUE of the kind
};

/// `limn make`: writes a generated mesh with its skin, skeleton and clips as a .glb, completely or
/// not at all; then a line that sums up the file. Weights of morph targets in clips are left out.
[[nodiscard]] Status run_make(const MakeOptions& options);

}  // namespace limn
