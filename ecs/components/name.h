#pragma once

#include "ecs/reflect.h"

#include <string>

namespace limn {

/// Name of the entity in levels, glTF nodes and the inspector.
struct Name {
    std::string text;
};

LIMN_FIELDS(Name) {
    LIMN_FIELD(text, "name of the entity");
}

}  // namespace limn
