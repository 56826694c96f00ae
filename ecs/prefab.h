#pragma once

#include "ecs/any_component.h"
#include "ecs/commands.h"
#include "ecs/hierarchy.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// A subtree as a template. Its entities hold component values; references to other entities of the
// prefab (the Parent of all but the root, a camera's target) are stored as indices and remapped for
// every spawned copy.

/// Refers to entity `index` of a prefab, for use in components of the same prefab only.
[[nodiscard]] constexpr Entity prefab_entity(std::uint32_t index) {
    return {index, 0xffffffffu};
}

struct PrefabEntity {
    std::vector<AnyComponent> components;    ///< each type at most once
    std::vector<ComponentId> disabled = {};  ///< components that start disabled in copies
};

struct Prefab {
    std::vector<PrefabEntity> entities;  ///< the root first
};

/// Copies `root` and its descendants, except the root's Parent and components that ComponentTraits
/// exclude (saved, in_prefabs) or that cannot be copied. References to outside entities are kept.
[[nodiscard]] Prefab make_prefab(World& world, Entity root);

/// Gives existing entities, one for each of the prefab's, its components.
void fill(World& world, const Prefab& prefab, std::span<const Entity> entities);

/// Creates `count` copies in one batch, as children of `parent` unless that is null. Returns their
/// roots. The entities of one copy are created after those of the previous copy.
std::vector<Entity>
spawn(World& world, const Prefab& prefab, std::size_t count = 1, Entity parent = {});

/// Creates one copy at the next sync point. Returns the root's placeholder.
Entity spawn(Commands commands, const Prefab& prefab, Entity parent = {});

}  // namespace limn
