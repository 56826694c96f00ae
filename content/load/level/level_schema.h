#pragma once

#include "content/load/files/json_document.h"

namespace limn {

/// JSON Schema (draft 2020-12) of a level file, derived from the reflection of all registered
/// components, resources and kinds of meshes and images, for validation and completion in editors.
[[nodiscard]] JsonValue level_schema();

}  // namespace limn
