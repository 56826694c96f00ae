#include "content/load/level_update.h"

#include "content/load/level_load.h"
#include "ecs/base/text.h"
#include "ecs/component_bytes.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

constexpr std::size_t kMaxFollowed = 20000;

bool same_value(const AnyComponent& a, const AnyComponent& b) {
    const ComponentInfo& info = a.info();
    return !is_serializable(info)
           || hash_values(info, a.data(), 1, 0) == hash_values(info, b.data(), 1, 0);
}

bool same_kinds(const std::vector<AnyComponent>& a, const std::vector<AnyComponent>& b) {
    bool same = a.size() == b.size();
    for (std::size_t i = 0; same && i < a.size(); ++i) {
        same = &a[i].info() == &b[i].info();
    }
    return same;
}

bool same_change(const NodeChange& a, const NodeChange& b) {
    const auto offset = [](const FieldEdit& edit) { return edit.offset; };
    return a.entity == b.entity && a.node == b.node && a.info == b.info
           && a.set.value.is_empty() == b.set.value.is_empty()
           && std::ranges::equal(a.set.edits, b.set.edits, {}, offset, offset)
           && (a.set.value.is_empty() || same_value(a.set.value, b.set.value));
}

}  // namespace

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
    return fields;
}

Result<std::size_t>
update_level(World& world, LevelFields& fields, const ShowChoice& choice, MadeAssets* made) {
    const std::string path = fields.files.empty() ? "" : fields.files.front();
    Level level = LIMN_TRY(load_level(path, {}, choice, made));
    LevelFields now = remember_fields(level, path);
    bool same = now.components.size() == fields.components.size() && now.assets == fields.assets;
    for (std::size_t i = 0; same && i < now.components.size(); ++i) {
        same = same_kinds(now.components[i], fields.components[i]);
    }
    if (!same) {
        return fail(
            "{}: entities, components or assets were added or removed: load it again", path);
    }
    if (!std::ranges::equal(now.node_changes, fields.node_changes, same_change)) {
        return fail("{}: nodes of a glTF file are changed otherwise: load it again", path);
    }
    std::size_t updated = 0;
    for (std::size_t i = 0; i < now.components.size(); ++i) {
        const Entity entity = fields.entities[i];
        for (std::size_t c = 0; c < now.components[i].size(); ++c) {
            AnyComponent value = now.components[i][c];
            const ComponentInfo& info = value.info();
            if (same_value(value, fields.components[i][c]) || !world.alive(entity)
                || !world.has(entity, info.id)) {
                continue;
            }
            localize_component(value, fields.entities);
            world.write(entity, info.id, value.data());
            ++updated;
        }
    }
    replace_events(world, std::move(level.events), fields.entities);
    now.entities = std::move(fields.entities);
    fields = std::move(now);
    return updated;
}

}  // namespace limn
