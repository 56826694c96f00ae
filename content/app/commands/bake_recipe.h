#pragma once

#include "content/app/commands/bake_command.h"
#include "content/load/files/json_document.h"
#include "content/load/level/component_json.h"
#include "ecs/base/result.h"

#include <span>
#include <string_view>

namespace limn {

/// Sets the fields of `recipe` that --set names.
template <typename Recipe>
[[nodiscard]] Status set_recipe_fields(std::span<const Assignment> assignments, Recipe& recipe) {
    for (const Assignment& set : assignments) {
        const Result<JsonValue> json = parse_json(set.value, "--set");
        const JsonValue value = json ? *json : json_of(std::string_view(set.value));
        LIMN_TRY(read_struct(json_object({{set.path, {}, value}}), recipe, {"--set", ""}, {}));
    }
    return Done{};
}

/// Sets the fields of `recipe` that the recipe file and --set name.
template <typename Recipe>
[[nodiscard]] Status read_recipe(const BakeOptions& options, Recipe& recipe) {
    if (!options.recipe.empty()) {
        const JsonValue json = LIMN_TRY(load_json(options.recipe));
        LIMN_TRY(read_struct(json, recipe, {options.recipe, ""}, {}));
    }
    return set_recipe_fields(options.assignments, recipe);
}

}  // namespace limn
