#include "ecs/prefab.h"

#include "ecs/component_bytes.h"

#include <algorithm>

// Techniques: engine.stock-active

namespace limn {

namespace {

/// Records the components of one copy; `entities` has one entity for each of the prefab's.
void record_copy(Commands commands, const Prefab& prefab, std::span<const Entity> entities) {
    for (std::size_t i = 0; i < entities.size(); ++i) {
        for (const AnyComponent& component : prefab.entities[i].components) {
            const ComponentInfo& info = component.info();
            if (!info.has_entities) {
                commands.add_copy(entities[i], info.id, component.data());
                continue;
            }
            AnyComponent copy = component;
            for_each_entity(info.fields, copy.data(), [entities](Entity& entity) {
                if (entity.generation == prefab_entity(0).generation
                    && entity.index < entities.size()) {
                    entity = entities[entity.index];
                }
            });
            commands.add_copy(entities[i], info.id, copy.data());
        }
        for (const ComponentId id : prefab.entities[i].disabled) {
            commands.set_enabled(entities[i], id, false);
        }
    }
}

void record_parent(Commands commands, Entity root, Entity parent) {
    if (!parent.is_null()) {
        commands.add(root, Parent{parent});
    }
}

}  // namespace

Prefab make_prefab(World& world, Entity root) {
    const std::vector<Entity> subtree = subtree_of(hierarchy(world), root);
    std::vector<std::pair<Entity, std::uint32_t>> numbers;
    for (std::uint32_t i = 0; i < subtree.size(); ++i) {
        numbers.emplace_back(subtree[i], i);
    }
    std::sort(numbers.begin(), numbers.end());

    Prefab prefab;
    prefab.entities.resize(subtree.size());
    const World& source = world;
    for (std::size_t i = 0; i < subtree.size(); ++i) {
        for (const ComponentId id : source.components_of(subtree[i])) {
            const ComponentInfo& info = component_info(id);
            const bool is_link_up = i == 0 && id == component_id<Parent>;
            if (!info.saved || !info.in_prefabs || info.ops.construct_copy == nullptr
                || is_link_up) {
                continue;
            }
            AnyComponent& copy = prefab.entities[i].components.emplace_back(
                AnyComponent::read(source, subtree[i], info));
            for_each_entity(info.fields, copy.data(), [&numbers](Entity& entity) {
                const auto found =
                    std::lower_bound(numbers.begin(), numbers.end(), std::pair(entity, 0u));
                if (found != numbers.end() && found->first == entity) {
                    entity = prefab_entity(found->second);
                }
            });
            if (!source.is_enabled(subtree[i], id)) {
                prefab.entities[i].disabled.push_back(id);
            }
        }
    }
    return prefab;
}

void fill(World& world, const Prefab& prefab, std::span<const Entity> entities) {
    LIMN_CHECK(entities.size() == prefab.entities.size());
    CommandBuffer buffer;
    record_copy(Commands(buffer), prefab, entities);
    CommandBuffer* const buffers[] = {&buffer};
    apply_commands(world, buffers);
}

std::vector<Entity> spawn(World& world, const Prefab& prefab, std::size_t count, Entity parent) {
    const std::size_t size = prefab.entities.size();
    const std::vector<Entity> entities = world.create_many(count * size);
    // Commands move every entity once, however many components it gets.
    CommandBuffer buffer;
    const Commands commands(buffer);
    std::vector<Entity> roots;
    for (std::size_t i = 0; i < count && size > 0; ++i) {
        const std::span<const Entity> copy =
            std::span<const Entity>(entities).subspan(i * size, size);
        record_copy(commands, prefab, copy);
        record_parent(commands, copy.front(), parent);
        roots.push_back(copy.front());
    }
    CommandBuffer* const buffers[] = {&buffer};
    apply_commands(world, buffers);
    return roots;
}

Entity spawn(Commands commands, const Prefab& prefab, Entity parent) {
    std::vector<Entity> entities;
    for (std::size_t i = 0; i < prefab.entities.size(); ++i) {
        entities.push_back(commands.create());
    }
    if (entities.empty()) {
        return {};
    }
    record_copy(commands, prefab, entities);
    record_parent(commands, entities.front(), parent);
    return entities.front();
}

}  // namespace limn
