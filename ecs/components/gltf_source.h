#pragma once

#include "ecs/reflect.h"

#include <string>

namespace limn {

/// The glTF file whose nodes are children of the entity: "gltf" of a level.
struct GltfSource {
    std::string file;
    std::string variant;
};

LIMN_FIELDS(GltfSource) {
    LIMN_FIELD(file, "relative to the level");
    LIMN_FIELD(variant, "of its materials; empty: the default");
}

/// Marks the entities that a glTF file made. The file is the GltfSource of the nearest ancestor, or
/// their own where the file is no part of a level.
struct FromGltf {};

}  // namespace limn
