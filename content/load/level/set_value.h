#pragma once

#include "content/load/level/component_json.h"
#include "content/load/level/level_update.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

class World;

/// `--set path=value`: changes one field of a loaded scene.
///
///     lamp.point_light.intensity = 20  entity, component, field; more dots for fields of structs;
///                                      a component that it lacks is added, with a warning
///     exposure.ev = -1                 resource, field; created if the scene has none
///     materials.gold.roughness = 0.4   a material by name
///
/// `value` is JSON as in a level; anything else is taken as a string, so that words and colors need
/// no quotes: `materials.gold.base_color = #ffcc80`. Changes all entities of that name, or nothing
/// on an error.
[[nodiscard]] Status set_value(World& world, std::string_view path, std::string_view value);

/// What a path of set_value names: components of entities, a resource or a material.
struct SetTarget {
    LevelPart part = LevelPart::Component;
    const ComponentInfo* info = nullptr;
    std::vector<Entity> entities;  ///< of a Component: all of that name
    std::uint32_t material = 0;    ///< index into Assets
    std::string field;             ///< with dots
};

[[nodiscard]] Result<SetTarget> find_set_target(const World& world, std::string_view path);

/// Resolve names of entities and assets of a world, for reading and writing components as JSON. The
/// world must outlive them.
[[nodiscard]] NameResolver make_name_resolver(const World& world);
[[nodiscard]] NameProvider make_name_provider(const World& world);

}  // namespace limn
