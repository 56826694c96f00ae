#include "content/load/level/level_update.h"

#include "content/load/level/component_json.h"
#include "content/load/level/level_load.h"
#include "ecs/base/text.h"
#include "ecs/component_bytes.h"
#include "ecs/field_access.h"
#include "ecs/field_watch.h"
#include "ecs/world.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace limn {
namespace {

constexpr std::size_t kMaxFollowed = 20000;

void add_change(std::vector<LevelChange>& changes, const AnyComponent& before, LevelChange change) {
    change.fields = changed_fields(before, change.now);
    if (!change.fields.empty()) {
        changes.push_back(std::move(change));
    }
}

/// The value of a resource in the files, or its default.
AnyComponent resource_in(const std::vector<AnyComponent>& resources, const ComponentInfo& info) {
    const auto found = std::ranges::find_if(
        resources, [&](const AnyComponent& one) { return &one.info() == &info; });
    return found != resources.end() ? *found : AnyComponent(info);
}

std::vector<LevelChange>
find_changes(const World& world, const LevelFields& before, const LevelFields& now) {
    std::vector<LevelChange> changes;
    for (std::size_t i = 0; i < now.components.size(); ++i) {
        const Entity entity = before.entities[i];
        for (std::size_t c = 0; c < now.components[i].size(); ++c) {
            const AnyComponent& value = now.components[i][c];
            if (world.alive(entity) && world.has(entity, value.info().id)) {
                add_change(
                    changes, before.components[i][c], {LevelPart::Component, entity, 0, value, {}});
            }
        }
    }
    std::vector<const ComponentInfo*> infos;
    for (const auto* const resources : {&before.resources, &now.resources}) {
        for (const AnyComponent& one : *resources) {
            if (std::ranges::find(infos, &one.info()) == infos.end()) {
                infos.push_back(&one.info());
            }
        }
    }
    for (const ComponentInfo* const info : infos) {
        add_change(
            changes, resource_in(before.resources, *info),
            {LevelPart::Resource, {}, 0, resource_in(now.resources, *info), {}});
    }
    for (std::uint32_t i = 0; i < now.materials.size(); ++i) {
        add_change(
            changes, AnyComponent::of(before.materials[i]),
            {LevelPart::Material, {}, i, AnyComponent::of(now.materials[i]), {}});
    }
    for (std::uint32_t i = 0; i < now.motion_graphs.size(); ++i) {
        const MotionGraphData old =
            i < before.motion_graphs.size() ? before.motion_graphs[i] : MotionGraphData{};
        add_change(
            changes, AnyComponent::of(old),
            {LevelPart::MotionGraph, {}, i, AnyComponent::of(now.motion_graphs[i]), {}});
    }
    return changes;
}

void apply_change(World& world, const LevelChange& change) {
    const ComponentInfo& info = change.now.info();
    switch (change.part) {
    case LevelPart::Component: {
        AnyComponent value = AnyComponent::read(world, change.entity, info);
        adopt_change(change, value);
        write_fields(world, change.entity, std::move(value));
        break;
    }
    case LevelPart::Resource: {
        void* resource = world.find_resource(info.id);
        resource = resource != nullptr ? resource : world.insert_default_resource(info.id);
        for (const FieldInfo* const field : change.fields) {
            copy_field(*field, field_ptr(resource, *field), field_ptr(change.now.data(), *field));
        }
        break;
    }
    case LevelPart::Material: {
        auto& assets = world.resource<Assets>();
        AnyComponent value = AnyComponent::of(assets.materials[change.material]);
        adopt_change(change, value);
        assets.materials[change.material] = value.as<Material>();
        ++assets.material_version;
        break;
    }
    case LevelPart::MotionGraph: {
        auto* const found = world.find_resource<MotionGraphs>();
        MotionGraphs& graphs = found != nullptr ? *found : world.insert_resource(MotionGraphs{});
        const auto& data = change.now.as<MotionGraphData>();
        if (change.material < graphs.graphs.size()) {
            graphs.edits.push_back({{change.material}, data});
        } else {
            graphs.graphs.push_back(data);
        }
        break;
    }
    }
}

/// Gives the graphs of the file the places that those of these names have in the world, new ones
/// the next, and keeps those that the file has no longer. What refers to them follows.
void place_graphs(const std::vector<MotionGraphData>& before, LevelFields& now, EventList& events) {
    std::vector<MotionGraphData> graphs = before;
    std::vector<std::uint32_t> places;
    for (MotionGraphData& graph : now.motion_graphs) {
        const auto found = std::ranges::find(graphs, graph.name, &MotionGraphData::name);
        places.push_back(static_cast<std::uint32_t>(found - graphs.begin()));
        if (found != graphs.end()) {
            *found = std::move(graph);
        } else {
            graphs.push_back(std::move(graph));
        }
    }
    now.motion_graphs = std::move(graphs);
    const auto place = [&](AnyComponent& value) {
        if (value.is_empty()) {
            return;
        }
        for_each_asset(
            value.info().fields, value.data(), [&](std::string_view kind, std::uint32_t& index) {
                if (kind == asset_kind<MotionGraphId> && index < places.size()) {
                    index = places[index];
                }
            });
    };
    const auto place_all = [&](std::vector<AnyComponent>& values) {
        std::ranges::for_each(values, place);
    };
    std::ranges::for_each(now.components, place_all);
    place_all(now.resources);
    for (NodeChange& change : now.node_changes) {
        place(change.set.value);
    }
    for (ScriptEvent& event : events.events) {
        for (ScriptAction& action : event.actions) {
            place(action.value);
            for (PrefabEntity& entity : action.prefab.entities) {
                place_all(entity.components);
            }
        }
    }
}

bool same_kinds(const std::vector<AnyComponent>& a, const std::vector<AnyComponent>& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
        same = &a[i].info() == &b[i].info();
    }
    return same;
}

/// Changes of one type of component.
bool same_edits(const ScriptAction& a, const ScriptAction& b) {
    const auto offset = [](const FieldEdit& edit) { return edit.offset; };
    return a.value.is_empty() == b.value.is_empty()
           && std::ranges::equal(a.edits, b.edits, {}, offset, offset)
           && (a.value.is_empty() || same_value(a.value, b.value));
}

bool same_change(const NodeChange& a, const NodeChange& b) {
    return a.entity == b.entity && a.node == b.node && a.info == b.info && same_edits(a.set, b.set);
}

/// Calls `visit` with what events at the start of the level set in components.
template <typename Visit>
void each_first_set(const EventList& list, Visit&& visit) {
    for (const ScriptEvent& event : list.events) {
        for (const ScriptAction& action : event.actions) {
            if (event.time == 0 && event.key.empty() && action.action == EventAction::Set
                && !action.is_resource) {
                visit(action);
            }
        }
    }
}

/// What events at the start of the level remove. In events that are not spawned yet, entities are
/// indices into `entities`.
std::vector<std::pair<Entity, const ComponentInfo*>>
first_removals(const EventList& list, const std::vector<Entity>& entities) {
    std::vector<std::pair<Entity, const ComponentInfo*>> removals;
    for (const ScriptEvent& event : list.events) {
        for (const ScriptAction& action : event.actions) {
            if (event.time != 0 || !event.key.empty() || action.action != EventAction::Remove) {
                continue;
            }
            const bool is_index = action.entity.generation == prefab_entity(0).generation;
            removals.emplace_back(
                is_index ? entities[action.entity.index] : action.entity, &action.value.info());
        }
    }
    return removals;
}

/// Applies what new or changed events set at the start of the level, which has passed already.
std::vector<LevelChange> find_first_sets(const World& world, const EventList& before) {
    std::vector<LevelChange> changes;
    each_first_set(world.resource<EventList>(), [&](const ScriptAction& action) {
        const ComponentInfo& info = action.value.info();
        bool is_new = world.alive(action.entity) && world.has(action.entity, info.id);
        each_first_set(before, [&](const ScriptAction& other) {
            is_new = is_new
                     && !(
                         other.entity == action.entity && &other.value.info() == &info
                         && same_edits(other, action));
        });
        if (!is_new) {
            return;
        }
        LevelChange change{
            LevelPart::Component,
            action.entity,
            0,
            AnyComponent::read(world, action.entity, info),
            {}};
        for (const FieldEdit& edit : action.edits) {
            copy_field(
                *edit.field, static_cast<std::byte*>(change.now.data()) + edit.offset,
                static_cast<const std::byte*>(action.value.data()) + edit.offset);
            const auto outer = std::ranges::find_if(info.fields, [&](const FieldInfo& field) {
                return edit.offset >= field.offset && edit.offset < field.offset + field.size;
            });
            change.fields.push_back(&*outer);
        }
        changes.push_back(std::move(change));
    });
    return changes;
}

/// The first name that only one of both lists has.
std::string
describe_difference(const std::vector<std::string>& before, const std::vector<std::string>& now) {
    const auto find_new = [](const auto& list, const auto& other) {
        return std::ranges::find_if(list, [&](const std::string& name) {
            return std::ranges::count(list, name) > std::ranges::count(other, name);
        });
    };
    if (const auto added = find_new(now, before); added != now.end()) {
        return fmt::format("\"{}\" was added", *added);
    }
    if (const auto removed = find_new(before, now); removed != before.end()) {
        return fmt::format("\"{}\" was removed", *removed);
    }
    return "the order of assets differs";
}

}  // namespace

bool same_value(const AnyComponent& a, const AnyComponent& b) {
    return changed_fields(a, b).empty();
}

void adopt_change(const LevelChange& change, AnyComponent& value) {
    for (const FieldInfo* const field : change.fields) {
        copy_field(*field, field_ptr(value.data(), *field), field_ptr(change.now.data(), *field));
    }
}

LevelFields remember_fields(const Level& level, const std::string& path) {
    LevelFields fields;
    if (level.entities.entities.size() > kMaxFollowed) {
        return fields;
    }
    fields.files.push_back(path);
    for (const auto& file : level.included) {
        fields.files.push_back(*file);
    }
    for (const PrefabEntity& entity : level.entities.entities) {
        fields.components.push_back(entity.components);
    }
    fields.node_changes = level.node_changes;
    fields.resources = level.resources;
    fields.materials = level.assets.materials;
    fields.motion_graphs = level.motion_graphs;
    const Assets& assets = level.assets;
    const auto add_names = [&](const auto& list) {
        for (const auto& asset : list) {
            fields.assets.push_back(asset.name);
        }
        fields.assets.emplace_back();
    };
    add_names(assets.images);
    add_names(assets.materials);
    add_names(assets.meshes);
    add_names(assets.paths);
    add_names(assets.clips);  // which graphs refer to
    return fields;
}

Result<std::vector<LevelChange>>
update_level(World& world, LevelFields& fields, const ShowChoice& choice, MadeAssets* made) {
    const std::string path = fields.files.empty() ? "" : fields.files.front();
    Level level = LIMN_TRY(load_level(path, {}, choice, made));
    LevelFields now = remember_fields(level, path);
    place_graphs(fields.motion_graphs, now, level.events);
    if (now.assets != fields.assets) {
        return fail(
            "{}: {}: reload the level", path, describe_difference(fields.assets, now.assets));
    }
    bool same = now.components.size() == fields.components.size();
    for (std::size_t i = 0; same && i < now.components.size(); ++i) {
        same = same_kinds(now.components[i], fields.components[i]);
    }
    if (!same) {
        return fail("{}: entities or components were added or removed: reload the level", path);
    }
    if (!std::ranges::equal(now.node_changes, fields.node_changes, same_change)) {
        return fail("{}: changes of glTF nodes differ: reload the level", path);
    }
    if (first_removals(world.resource<EventList>(), fields.entities)
        != first_removals(level.events, fields.entities)) {
        return fail("{}: events at the start remove other components: reload the level", path);
    }
    std::vector<LevelChange> changes = find_changes(world, fields, now);
    for (LevelChange& change : changes) {
        localize_component(change.now, fields.entities);
        apply_change(world, change);
    }
    const EventList before = world.resource<EventList>();
    replace_events(world, std::move(level.events), fields.entities);
    for (LevelChange& change : find_first_sets(world, before)) {
        apply_change(world, change);
        changes.push_back(std::move(change));
    }
    now.entities = std::move(fields.entities);
    fields = std::move(now);
    return changes;
}

}  // namespace limn
