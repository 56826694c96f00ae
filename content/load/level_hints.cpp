#include "content/load/level_hints.h"

#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace limn {

bool is_internal(const ComponentInfo& info) {
    constexpr std::string_view kInternal[] = {
        "pose",
        "previous_world_transform",
        "world_transform",
        "input",
        "sibling_order",
        "thrown_stone",
        "gltf_source"};
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
    return did_you_mean;
}

}  // namespace limn
