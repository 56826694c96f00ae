#pragma once

#include "ecs/reflect.h"

#include <string>

namespace limn {

/// The glTF file whose nodes are children of the entity: "gltf" of a level.
struct GltfSource {
    std::string file;
};

LIMN_FIELDS(GltfSource) {
    LIMN_FIELD(file, "relative to the level");
}

}  // namespace limn
