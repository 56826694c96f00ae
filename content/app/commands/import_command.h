#pragma once

#include "ecs/base/result.h"

#include <string>

namespace limn {

// Shown by `limn import markers take.trc -o take.glb`: face.head-stabilise, face.mocap-drive

struct ImportOptions {
    std::string kind;   ///< ict-facekit, makehuman or markers
    std::string in;     ///< folder, or the file of markers
    std::string out;    ///< .glb
    bool head = false;  ///< markers are named after those of the built-in head
};

/// `limn import`: converts other formats to a .glb, written completely or not at all. Progress on a
/// terminal; then a line that sums up the file.
[[nodiscard]] Status run_import(const ImportOptions& options);

}  // namespace limn
