#include "content/load/level/level_nodes.h"

#include "content/load/level/level_events.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/level_load.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <algorithm>
#include <string_view>

namespace limn {
namespace {

Status read_change(
    const JsonMember& member, const JsonLocation& at, const NameResolver& names,
    NodeChange& change) {
    const ComponentInfo* const info = find_component(member.key);
    if (info == nullptr || info->ops.construct_default == nullptr
        || info->ops.construct_copy == nullptr || is_internal(*info)) {
        return error_at(
            at, member.at, "the component " + in_quotes(member.key),
            "one of `limn components`"
                + where_it_belongs(member.key, component_suggestion(member.key)));
    }
    change.info = info;
    if (member.value.kind == JsonKind::Null) {
        return Done{};
    }
    return read_edits(member.value, *info, location_in(at, member.key), names, change.set);
}

/// The entities created by files below `entity`, but not below other entities of the level.
void collect_nodes(World& world, Entity entity, std::vector<Entity>& nodes) {
    for (const Entity child : children_of(world, entity)) {
        if (world.has<FromGltf>(child)) {
            nodes.push_back(child);
            collect_nodes(world, child, nodes);
        }
    }
}

bool is_named(const World& world, Entity entity, std::string_view name) {
    const auto* const own = world.find<Name>(entity);
    return own != nullptr && own->text == name;
}

/// Whether it is one of several parts of a node and has a material of that name.
bool is_part(const World& world, Entity entity, std::string_view material) {
    const auto* const instance = world.find<MeshInstance>(entity);
    const auto* const assets = world.find_resource<Assets>();
    return instance != nullptr && assets != nullptr && !world.has<Name>(entity)
           && instance->material.index < assets->materials.size()
           && assets->materials[instance->material.index].name == material;
}

/// Whether one of several parts of a node has a material of that name.
bool has_part(const GltfScene& scene, const GltfNode& node, std::string_view material) {
    return node.parts.size() > 1 && std::ranges::any_of(node.parts, [&](const GltfPart& part) {
               return scene.materials[part.material].name == material;
           });
}

/// The entities of a node that have or get the component.
std::vector<Entity> find_targets(World& world, Entity node, const ComponentInfo& info) {
    std::vector<Entity> targets;
    if (&info == &component_info<MeshInstance>() && !world.has<MeshInstance>(node)) {
        for (const Entity part : children_of(world, node)) {
            if (world.has<FromGltf>(part) && world.has<MeshInstance>(part)
                && !world.has<Name>(part)) {
                targets.push_back(part);
            }
        }
    }
    return targets.empty() ? std::vector{node} : targets;
}

void change_component(World& world, Entity entity, const NodeChange& change) {
    const ComponentInfo& info = *change.info;
    if (change.set.value.is_empty()) {
        world.remove(entity, info.id);
        return;
    }
    world.add(entity, info.id);
    AnyComponent component = AnyComponent::read(world, entity, info);
    for (const FieldEdit& edit : change.set.edits) {
        copy_field(
            *edit.field, static_cast<std::byte*>(component.data()) + edit.offset,
            static_cast<const std::byte*>(change.set.value.data()) + edit.offset);
    }
    world.write(entity, info.id, component.data());
}

}  // namespace

Status read_node_changes(
    const JsonValue& json, std::uint32_t entity, const JsonLocation& location,
    const NameResolver& names, std::vector<NodeChange>& changes) {
    LIMN_TRY(expect(json, JsonKind::Object, location, "an object: nodes of the glTF file by name"));
    for (const JsonMember& node : json.members) {
        const JsonLocation at = location_in(location, node.key);
        LIMN_TRY(expect(node.value, JsonKind::Object, at, "an object: components by name"));
        for (const JsonMember& component : node.value.members) {
            NodeChange change{entity, node.key, node.at, nullptr, {}};
            LIMN_TRY(read_change(component, at, names, change));
            changes.push_back(std::move(change));
        }
    }
    return Done{};
}

Status find_changed_nodes(Level& level) {
    for (std::size_t i = 0; i < level.gltfs.size(); ++i) {
        const std::vector<std::uint32_t>& users = level.gltfs[i].entities;
        for (const NodeChange& change : level.node_changes) {
            if (std::find(users.begin(), users.end(), change.entity) == users.end()) {
                continue;
            }
            bool found = false;
            std::vector<std::string_view> names;
            for (GltfNode& node : level.scenes[i].nodes) {
                names.emplace_back(node.name);
                node.is_named = node.is_named || node.name == change.node;
                found = found || node.name == change.node
                        || has_part(level.scenes[i], node, change.node);
            }
            if (!found) {
                return error_at(
                    {level.file, "nodes"}, change.at, "the node " + in_quotes(change.node),
                    "a node of " + level.gltfs[i].file + did_you_mean(change.node, names));
            }
        }
    }
    return Done{};
}

void apply_node_changes(
    World& world, std::span<const NodeChange> changes, std::span<const Entity> entities) {
    struct Target {
        const NodeChange* change;
        Entity entity;
    };
    std::vector<Target> targets;  // all are found before the first is changed
    std::vector<Entity> nodes;
    for (std::size_t i = 0; i < changes.size(); ++i) {
        if (i == 0 || changes[i].entity != changes[i - 1].entity) {
            nodes.clear();
            collect_nodes(world, entities[changes[i].entity], nodes);
        }
        for (const Entity node : nodes) {
            if (!is_named(world, node, changes[i].node) && !is_part(world, node, changes[i].node)) {
                continue;
            }
            for (const Entity target : find_targets(world, node, *changes[i].info)) {
                targets.push_back({&changes[i], target});
            }
        }
    }
    for (const Target& target : targets) {
        change_component(world, target.entity, *target.change);
    }
}

}  // namespace limn
