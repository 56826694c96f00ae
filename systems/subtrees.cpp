#include "systems/subtrees.h"

#include "ecs/base/text.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/name.h"
#include "ecs/components/placement.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"
#include "ecs/hierarchy.h"
#include "ecs/prefab.h"
#include "ecs/world.h"
#include "systems/attach_system.h"

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include <cctype>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

// Techniques: engine.cut-copy-paste

namespace limn {
namespace {

/// "lamp" of "lamp 2".
std::string_view without_number(std::string_view name) {
    std::size_t end = name.size();
    while (end > 0 && std::isdigit(static_cast<unsigned char>(name[end - 1])) != 0) {
        --end;
    }
    const bool numbered = end < name.size() && end > 1 && name[end - 1] == ' ';
    return numbered ? name.substr(0, end - 1) : name;
}

/// Gives the entities names that no other entity has.
void rename_copies(World& world, const std::vector<Entity>& copies) {
    std::unordered_set<std::string> used;
    const std::unordered_set<Entity> own(copies.begin(), copies.end());
    world.query<const Name>().each([&](Entity entity, const Name& name) {
        if (!own.contains(entity)) {
            used.insert(name.text);
        }
    });
    for (const Entity entity : copies) {
        if (!world.has<Name>(entity) || world.has<FromGltf>(entity)) {
            continue;
        }
        const std::string text = world.value<Name>(entity).text;
        std::string unique = text;
        for (int i = 2; !text.empty() && !used.insert(unique).second; ++i) {
            unique = fmt::format("{} {}", without_number(text), i);
        }
        world.set(entity, Name{std::move(unique)});
    }
}

/// The Transform in `parent` of what is at `placed` in the world.
Transform placed_in(World& world, Entity parent, const Affine& placed) {
    return decompose_affine(
        to_affine(glm::inverse(to_mat4(world_from_entity(world, parent)))) * placed);
}

}  // namespace

Status cut_tree(World& world, Entity entity, KeptPlace kept) {
    if (!world.alive(entity) || parent_of(world, entity).is_null()) {
        return fail("cut: found a root or a destroyed entity, expected a child");
    }
    if (kept == KeptPlace::World && world.has<Transform>(entity)) {
        return detach(world, entity) ? Status(Done{}) : fail("cut: the entity cannot be detached");
    }
    return set_parent(world, entity, {});
}

Result<Entity> copy_tree(World& world, Entity entity) {
    if (!world.alive(entity)) {
        return fail("copy: found a destroyed entity, expected a living one");
    }
    return spawn_tree(world, make_prefab(world, entity));
}

Entity spawn_tree(World& world, const Prefab& prefab) {
    const Entity root = spawn(world, prefab).front();
    rename_copies(world, subtree_of(hierarchy(world), root));
    return root;
}

Status paste_tree(World& world, Entity parent, Entity root, KeptPlace kept) {
    if (!world.alive(parent) || !world.alive(root)) {
        return fail("paste: found a destroyed entity, expected living ones");
    }
    if (!parent_of(world, root).is_null()) {
        return fail("paste: found an entity that has a parent, expected a root: cut it first");
    }
    const bool moves = kept == KeptPlace::World && world.has<Transform>(root);
    const Transform placed =
        moves ? placed_in(world, parent, world_from_entity(world, root)) : Transform{};
    if (!validate_fields(component_info<Transform>(), &placed)) {
        return fail("paste: found a parent without size, expected one with an inverse");
    }
    LIMN_TRY(set_parent(world, root, parent));
    if (moves) {
        world.add(root, placed);
    }
    return Done{};
}

}  // namespace limn
