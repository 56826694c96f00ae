#include "content/load/level/level_hints.h"

#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace limn {
namespace {

constexpr std::size_t kMaxOwners = 3;  // more owners make a poor hint

/// The types that have a field `name`.
std::vector<std::string_view>
names_with_field(const std::vector<const ComponentInfo*>& types, std::string_view name) {
    std::vector<std::string_view> names;
    for (const ComponentInfo* const info : types) {
        const bool has_it =
            std::any_of(info->fields.begin(), info->fields.end(), [name](const FieldInfo& field) {
                return field.name == name;
            });
        if (has_it && !is_internal(*info)) {
            names.emplace_back(info->name);
        }
    }
    return names;
}

}  // namespace

bool is_internal(const ComponentInfo& info) {
    constexpr std::string_view kInternal[] = {
        "pose",
        "previous_world_transform",
        "world_transform",
        "input",
        "sibling_order",
        "thrown_stone",
        "gltf_source",
        "from_gltf",
        "particle_pool"};
    return info.name.ends_with("_state")
           || std::find(std::begin(kInternal), std::end(kInternal), info.name)
                  != std::end(kInternal);
}

std::string where_it_belongs(std::string_view name, const std::string& did_you_mean) {
    if (find_resource(name) != nullptr) {
        return fmt::format(" (\"{}\" is a resource: it belongs in \"resources\")", name);
    }
    if (find_component(name) != nullptr) {
        return fmt::format(
            " (\"{}\" is a component: it belongs on an entity, beside its other components)", name);
    }
    if (!did_you_mean.empty()) {
        return did_you_mean;
    }
    std::vector<std::string_view> owners = names_with_field(all_components(), name);
    owners = owners.empty() ? names_with_field(all_resources(), name) : owners;
    return owners.empty() || owners.size() > kMaxOwners
               ? ""
               : fmt::format(" (\"{}\" is a field of {})", name, fmt::join(owners, " or "));
}

}  // namespace limn
