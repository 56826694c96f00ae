#pragma once

#include "ecs/reflect.h"

#include <string>

namespace limn {

/// What a level, a glTF node or the inspector calls the entity.
struct Name {
    std::string text;
};

template <typename Visitor>
void visit_fields(Name& name, Visitor&& visit) {
    visit("text", name.text, {.doc = "what the entity is called"});
}

}  // namespace limn
