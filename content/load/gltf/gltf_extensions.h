#pragma once

#include "content/load/files/json_document.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// Warns of each extension that is not read. Fails if one of them is required and not only looks
/// depend on it: one line with all of them, and the tool that converts the file.
[[nodiscard]] Status check_gltf_extensions(
    const JsonValue& json, const std::string& file, std::vector<std::string>& warnings);

}  // namespace limn
