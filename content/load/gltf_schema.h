#pragma once

#include "content/load/json_document.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

// The shape of the JSON of a glTF file: every property that we read has its type and range, every
// index leads to something that exists. One table of rules (gltf_schema.cpp); unknown properties
// are ignored, as the specification wants. tinygltf drops what has the wrong type in silence, and
// uses some indices unchecked; after this it finds neither.

/// Fails with "file: nodes[3].mesh: found the number 7, expected an index below 2".
[[nodiscard]] Status check_gltf_schema(const JsonValue& json, const std::string& file);

}  // namespace limn
