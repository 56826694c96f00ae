#include "content/load/asset_lists.h"
#include "content/load/gltf/gltf_spawn.h"
#include "content/load/level/level_load.h"
#include "ecs/command_buffer.h"
#include "ecs/commands.h"
#include "ecs/component_bytes.h"
#include "ecs/components/gltf_source.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

namespace limn {

namespace {

/// Replaces indices of level entities by handles. In a prefab that an event spawns (`is_outside`),
/// references to its own entities are kept.
void set_entities(AnyComponent& component, const std::vector<Entity>& entities, bool is_outside) {
    const std::uint32_t generation =
        is_outside ? level_entity(0).generation : prefab_entity(0).generation;
    for_each_entity(component.info().fields, component.data(), [&](Entity& entity) {
        if (entity.generation == generation && entity.index < entities.size()) {
            entity = entities[entity.index];
        }
    });
}

void localize(
    Prefab& prefab, const AssetOffsets& offsets, const std::vector<Entity>& entities,
    bool is_outside) {
    for (PrefabEntity& entity : prefab.entities) {
        for (AnyComponent& component : entity.components) {
            offset_asset_ids(component.info(), component.data(), offsets);
            if (component.info().has_entities) {
                set_entities(component, entities, is_outside);
            }
        }
    }
}

void localize(EventList& list, const AssetOffsets& offsets, const std::vector<Entity>& entities) {
    for (ScriptEvent& event : list.events) {
        for (ScriptAction& action : event.actions) {
            if (action.entity.generation == prefab_entity(0).generation) {
                action.entity = entities[action.entity.index];
            }
            if (!action.value.is_empty()) {
                offset_asset_ids(action.value.info(), action.value.data(), offsets);
                set_entities(action.value, entities, false);
            }
            localize(action.prefab, offsets, entities, true);
        }
    }
}

/// Creates all entities at once: Commands move each only once, whatever its number of components.
std::vector<Entity> create_entities(World& world, Prefab& prefab, const AssetOffsets& offsets) {
    const std::vector<Entity> entities = world.create_many(prefab.entities.size());
    localize(prefab, offsets, entities, false);
    CommandBuffer buffer;
    const Commands commands(buffer);
    for (std::size_t i = 0; i < entities.size(); ++i) {
        for (const AnyComponent& component : prefab.entities[i].components) {
            commands.add_copy(entities[i], component.info().id, component.data());
        }
    }
    CommandBuffer* const buffers[] = {&buffer};
    apply_commands(world, buffers);
    return entities;
}

/// Replaces references to the character `from` in the prefab by `to`.
void change_character(Prefab& prefab, Entity from, Entity to) {
    for (PrefabEntity& entity : prefab.entities) {
        for (AnyComponent& component : entity.components) {
            if (component.info().has_entities) {
                for_each_entity(
                    component.info().fields, component.data(),
                    [from, to](Entity& named) { named = named == from ? to : named; });
            }
        }
    }
}

/// The first use adds the assets of the file; further uses copy its entities.
void spawn_scene(
    World& world, Assets& assets, GltfScene scene, const GltfUse& use,
    const std::vector<Entity>& entities) {
    for (const std::uint32_t index : use.entities) {
        world.add(entities[index], GltfSource{use.file, use.variant});
    }
    const Entity first = entities[use.entities.front()];
    const SpawnedGltf spawned = spawn_gltf(world, assets, std::move(scene), first);
    std::vector<Prefab> prefabs;
    for (const Entity root : spawned.roots) {
        prefabs.push_back(make_prefab(world, root));
    }
    for (std::size_t i = 1; i < use.entities.size(); ++i) {
        const Entity entity = entities[use.entities[i]];
        for (Prefab& prefab : prefabs) {
            change_character(prefab, entities[use.entities[i - 1]], entity);
            (void)spawn(world, prefab, 1, entity);
        }
        if (spawned.rig.is_character) {
            make_character(world, entity, spawned.rig);
        }
    }
}

void set_resource(World& world, AnyComponent& resource, const AssetOffsets& offsets) {
    const ComponentInfo& info = resource.info();
    offset_asset_ids(info, resource.data(), offsets);
    void* target = world.find_resource(info.id);
    if (target == nullptr) {
        target = world.insert_default_resource(info.id);
    }
    for (const FieldInfo& field : info.fields) {
        copy_field(field, field_ptr(target, field), field_ptr(resource.data(), field));
    }
}

}  // namespace

void localize_component(AnyComponent& component, const std::vector<Entity>& entities) {
    if (component.info().has_entities) {
        set_entities(component, entities, false);
    }
}

void replace_events(World& world, EventList events, const std::vector<Entity>& entities) {
    localize(events, {}, entities);
    world.insert_resource(std::move(events));
}

std::vector<Entity> spawn_level(World& world, Level level) {
    if (world.find_resource<Assets>() == nullptr) {
        world.insert_resource(Assets{});
    }
    Assets& assets = world.resource<Assets>();
    AssetOffsets offsets = append_assets(assets, level.assets);
    if (!level.motion_graphs.empty()) {
        if (world.find_resource<MotionGraphs>() == nullptr) {
            world.insert_resource(MotionGraphs{});
        }
        append_graphs(world.resource<MotionGraphs>(), level.motion_graphs, offsets);
    }

    for (AnyComponent& resource : level.resources) {
        set_resource(world, resource, offsets);
    }
    world.insert_resource(std::move(level.bindings));
    std::vector<Entity> entities = create_entities(world, level.entities, offsets);
    for (std::size_t i = 0; i < level.scenes.size(); ++i) {
        spawn_scene(world, assets, std::move(level.scenes[i]), level.gltfs[i], entities);
    }
    for (NodeChange& change : level.node_changes) {
        if (!change.set.value.is_empty()) {
            offset_asset_ids(*change.info, change.set.value.data(), offsets);
            set_entities(change.set.value, entities, false);
        }
    }
    apply_node_changes(world, level.node_changes, entities);
    localize(level.events, offsets, entities);
    world.insert_resource(std::move(level.events));
    return entities;
}

}  // namespace limn
