#pragma once

#include <string>

namespace limn {

/// What a level, a glTF node or the inspector calls the entity.
struct Name {
    std::string text;
};

}  // namespace limn
