#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The files that an OBJ or its material libraries name, which are never opened outside of the
// folder of the OBJ. Names were written on other machines: in this order, a file is looked for as
// named, without quotes, with / for \, with %20 as a space, without its folders, and in any case of
// its letters.

struct ObjFetched {
    std::string path;  ///< relative to the folder of the OBJ
    std::vector<std::byte> bytes;
};

/// The bytes of `name`, in `subfolder` of `folder` or else in `folder`. `position` is the prefix of
/// the message.
[[nodiscard]] Result<ObjFetched> fetch_obj_file(
    std::string_view name, const std::string& folder, const std::string& subfolder,
    const std::string& position, std::uint64_t max_bytes);

/// The folder of a path, "" without one.
[[nodiscard]] std::string folder_of(const std::string& path);

}  // namespace limn
