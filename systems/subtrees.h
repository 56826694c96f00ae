#pragma once

#include "ecs/base/result.h"
#include "ecs/entity.h"

#include <cstdint>

namespace limn {

class World;
struct Prefab;

// Cut, copy and paste of entities with all their descendants (engine.cut-copy-paste). What was cut
// or copied is a root until it is pasted. Each fails, and changes nothing, if an entity is
// destroyed. content/app/panels/subtree_edits.h has the same as commands with undo.

/// What a subtree keeps when its parent changes.
enum class KeptPlace : std::uint8_t {
    Local,  ///< its Transform
    World,  ///< its place in the world, except for shear
};

/// Makes `entity` a root. Fails also for a root.
[[nodiscard]] Status cut_tree(World& world, Entity entity, KeptPlace kept = KeptPlace::Local);

/// Copies the components of `entity` and its descendants, as make_prefab does, to new entities;
/// references among them are to the copies. Names of the copies are new: "lamp" becomes "lamp 2",
/// except for nodes of glTF files. Returns the new root.
[[nodiscard]] Result<Entity> copy_tree(World& world, Entity entity);

/// Creates an instance with such names. Returns its root.
Entity spawn_tree(World& world, const Prefab& prefab);

/// Makes `root` the last child of `parent`. Fails also if it has a parent already, or if `parent`
/// is `root` or one of its descendants.
[[nodiscard]] Status
paste_tree(World& world, Entity parent, Entity root, KeptPlace kept = KeptPlace::Local);

}  // namespace limn
