#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// URIs in untrusted files (glTF, OBJ, levels): data URIs, or files under one folder and nothing
// else.

/// The bytes of a data: URI, or of a file under `folder`. Rejects other schemes, absolute paths,
/// "..", symbolic links out of the folder, and all files when `folder` is "".
[[nodiscard]] Result<std::vector<std::byte>> fetch_uri(
    const std::string& uri, const std::string& folder, const std::string& location,
    std::uint64_t max_bytes);

}  // namespace limn
