#pragma once

#include "ecs/any_component.h"
#include "ecs/commands.h"
#include "ecs/hierarchy.h"

#include <cstdint>
#include <vector>

namespace limn {

// A subtree as a template. Its entities hold component values; where a value names another entity
// of the prefab (the Parent of all but the root, a camera's target), it says which one by number,
// and every spawned copy gets its own.

/// Number `index` of a prefab's entities, for use in the components of the same prefab only.
[[nodiscard]] constexpr Entity prefab_entity(std::uint32_t index) {
    return {index, 0xffffffffu};
}

struct PrefabEntity {
    std::vector<AnyComponent> components;    ///< each type at most once
    std::vector<ComponentId> disabled = {};  ///< those of them that copies have disabled
};

struct Prefab {
    std::vector<PrefabEntity> entities;  ///< the root first
};

/// Copies `root` and everything below it. What ComponentTraits keep from it (saved, in_prefabs)
/// or cannot be copied is left out, and so is the root's Parent. Entities outside are named as they
/// are.
[[nodiscard]] Prefab make_prefab(World& world, Entity root);

/// `count` copies in one batch, under `parent` unless that is null. Returns their roots. The
/// entities of one copy are created after those of the copy before.
std::vector<Entity>
spawn(World& world, const Prefab& prefab, std::size_t count = 1, Entity parent = {});

/// One copy at the next sync point. Returns the root's placeholder.
Entity spawn(Commands commands, const Prefab& prefab, Entity parent = {});

}  // namespace limn
