#pragma once

#include "ecs/base/type_name.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// The entry called `name` of a list of kinds, of meshes or patterns; nullptr if there is none.
template <typename Kinds>
[[nodiscard]] auto find_kind(const Kinds& kinds, std::string_view name) -> decltype(kinds.data()) {
    for (const auto& kind : kinds) {
        if (kind.name == name) {
            return &kind;
        }
    }
    return nullptr;
}

/// "one of box sphere teapot", the expectation in errors about an unknown kind.
template <typename Kinds>
[[nodiscard]] std::string kind_names(const Kinds& kinds) {
    std::string names = "one of";
    for (const auto& kind : kinds) {
        names.append(" ").append(kind.name);
    }
    return names;
}

/// "" or " (did you mean teapot?)", to append to an error about an unknown kind.
template <typename Kinds>
[[nodiscard]] std::string kind_suggestion(const Kinds& kinds, std::string_view name) {
    std::vector<std::string> names;
    for (const auto& kind : kinds) {
        names.emplace_back(kind.name);
    }
    const std::string nearest = nearest_name(name, names);
    return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
}

}  // namespace limn
