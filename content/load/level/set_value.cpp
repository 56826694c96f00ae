#include "content/load/level/set_value.h"

#include "content/load/asset_lists.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/field_watch.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>

// Techniques: engine.param-access

namespace limn {

namespace {

std::vector<Entity> find_entities(const World& world, std::string_view name) {
    std::vector<Entity> entities;
    world.query<const Name>().each([&](Entity entity, const Name& candidate) {
        if (candidate.text == name) {
            entities.push_back(entity);
        }
    });
    return entities;
}

JsonValue parse_value(std::string_view text) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_blank(text.front())) {
        text.remove_prefix(1);
    }
    while (!text.empty() && is_blank(text.back())) {
        text.remove_suffix(1);
    }
    Result<JsonValue> json = parse_json(text, "");
    return json ? *std::move(json) : json_of(text);
}

/// Sets the field in a copy and assigns that to `object` on success. A struct can be set as a
/// whole; its fields that the value does not name are kept.
Status set_field(
    const ComponentInfo& info, void* object, std::string_view field_path, const JsonValue& value,
    const JsonLocation& location, const NameResolver& names) {
    AnyComponent copy(info, object);
    const Result<FieldRef> field = field_at(info, copy.data(), field_path);
    if (!field) {
        return fail("{}: {}", location.file, field.error().message);
    }
    FieldInfo target = *field->field;
    void* data = field->element;
    const bool is_indexed = field_path.back() >= '0' && field_path.back() <= '9';
    if (target.shape == FieldShape::List && field_path == target.name) {
        data = field_ptr(copy.data(), target);  // the list itself, which may be empty
    } else if (target.shape == FieldShape::List && !is_indexed) {
        return fail(
            "{}: found a list inside a list, expected the index of an element", location.file);
    } else if (is_indexed) {
        target.shape = FieldShape::One;
    }
    LIMN_TRY(read_field(value, target, data, location, names));
    if (const std::string problem = constraint_error(info, copy.data()); !problem.empty()) {
        return fail("{}: {}", location.file, problem);
    }
    for (const FieldInfo& changed : info.fields) {
        copy_field(changed, field_ptr(object, changed), field_ptr(copy.data(), changed));
    }
    return Done{};
}

/// For entities that lack the component: adds it first, with defaults.
Status add_to_entities(
    World& world, const std::vector<Entity>& entities, const ComponentInfo& info,
    std::string_view field_path, const JsonValue& value, const JsonLocation& location) {
    if (info.ops.construct_default == nullptr) {
        return fail(
            "{}: found no component {} on the entity, expected one", location.file, info.name);
    }
    AnyComponent fresh(info);
    LIMN_TRY(set_field(info, fresh.data(), field_path, value, location, make_name_resolver(world)));
    for (const Entity entity : entities) {
        world.add(entity, info.id);
        world.write(entity, info.id, fresh.data());
    }
    log_warn("{}: the entity has no {}; it is added with defaults", location.file, info.name);
    return Done{};
}

Status set_in_entities(
    World& world, const std::vector<Entity>& entities, const ComponentInfo& info,
    std::string_view field_path, const JsonValue& value, const JsonLocation& location) {
    std::vector<std::pair<Entity, AnyComponent>> changed;
    for (const Entity entity : entities) {
        AnyComponent component = AnyComponent::read(world, entity, info);
        if (component.is_empty()) {
            continue;
        }
        LIMN_TRY(set_field(
            info, component.data(), field_path, value, location, make_name_resolver(world)));
        changed.emplace_back(entity, std::move(component));
    }
    for (auto& [entity, component] : changed) {
        write_fields(world, entity, std::move(component));
    }
    return !changed.empty() ? Status(Done{})
                            : add_to_entities(world, entities, info, field_path, value, location);
}

/// Creates the resource with default values first if the scene has none.
Status set_in_resource(
    World& world, const ComponentInfo& info, std::string_view field_path, const JsonValue& value,
    const JsonLocation& location) {
    const NameResolver names = make_name_resolver(world);
    if (void* const object = world.find_resource(info.id)) {
        return set_field(info, object, field_path, value, location, names);
    }
    AnyComponent fresh(info);
    LIMN_TRY(set_field(info, fresh.data(), field_path, value, location, names));
    void* const made = world.insert_default_resource(info.id);
    for (const FieldInfo& field : info.fields) {
        copy_field(field, field_ptr(made, field), field_ptr(fresh.data(), field));
    }
    return Done{};
}

Result<SetTarget>
find_material_target(const World& world, std::string_view rest, const JsonLocation& location) {
    const Assets* const assets = world.find_resource<Assets>();
    std::vector<std::string_view> names;
    SetTarget target;
    std::size_t longest = 0;
    for (std::size_t i = 0; assets != nullptr && i < assets->materials.size(); ++i) {
        const std::string& name = assets->materials[i].name;
        names.emplace_back(name);
        // Names of glTF materials may contain dots: the longest match is used.
        if (rest.starts_with(name + '.') && (target.info == nullptr || name.size() > longest)) {
            longest = name.size();
            target = {
                LevelPart::Material,
                &component_info<Material>(),
                {},
                static_cast<std::uint32_t>(i),
                std::string(rest.substr(longest + 1))};
        }
    }
    if (target.info != nullptr) {
        return target;
    }
    const std::string_view name = rest.substr(0, rest.find('.'));
    return fail(
        "{}: found the material {}, expected one of the scene and a field{}", location.file,
        in_quotes(name), did_you_mean(name, names));
}

/// The error if no entity's name begins `path`, with the longest prefix that is similar
/// to a name.
Error unknown_target(const World& world, std::string_view path, const JsonLocation& location) {
    std::vector<std::string_view> known = make_name_resolver(world).all("entity");
    for (const ComponentInfo* const resource : all_resources()) {
        known.emplace_back(resource->name);
    }
    std::string_view name = path;
    std::string hint;
    while (hint.empty() && name.find('.') != std::string_view::npos) {
        name = name.substr(0, name.rfind('.'));
        hint = did_you_mean(name, known);
    }
    return fail(
        "{}: found {}, expected an entity, a resource or materials before a dot{}", location.file,
        in_quotes(name), hint);
}

/// Splits `path` at the last dot after an entity's name: names of glTF nodes may
/// contain dots.
Result<SetTarget>
find_named_target(const World& world, std::string_view path, const JsonLocation& location) {
    for (std::size_t dot = path.rfind('.'); dot != std::string_view::npos && dot > 0;
         dot = path.rfind('.', dot - 1)) {
        std::vector<Entity> entities = find_entities(world, path.substr(0, dot));
        if (entities.empty()) {
            continue;
        }
        const std::string_view rest = path.substr(dot + 1);
        const std::size_t end = std::min(rest.find('.'), rest.size());
        const std::string_view component = rest.substr(0, end);
        const ComponentInfo* const info = find_component(component);
        if (info == nullptr) {
            return fail(
                "{}: found the component {}, expected one of `limn components`{}", location.file,
                in_quotes(component), component_suggestion(component));
        }
        if (end + 1 >= rest.size()) {
            return fail("{}: found no field after {}, expected one", location.file, info->name);
        }
        return SetTarget{
            LevelPart::Component, info, std::move(entities), 0, std::string(rest.substr(end + 1))};
    }
    if (!find_entities(world, path).empty()) {
        return fail("{}: found no component, expected ENTITY.COMPONENT.FIELD", location.file);
    }
    return unknown_target(world, path, location);
}

}  // namespace

Result<SetTarget> find_set_target(const World& world, std::string_view path) {
    const std::string name = "--set " + std::string(path);
    const JsonLocation location{name, ""};
    const std::size_t dot = path.find('.');
    if (dot == std::string_view::npos || dot + 1 >= path.size()) {
        return fail("{}: found no field, expected ENTITY.COMPONENT.FIELD or RESOURCE.FIELD", name);
    }
    const std::string_view first = path.substr(0, dot);
    if (first == "materials") {
        return find_material_target(world, path.substr(dot + 1), location);
    }
    const ComponentInfo* const resource = find_resource(first);
    if (resource != nullptr && find_entities(world, first).empty()) {
        return SetTarget{LevelPart::Resource, resource, {}, 0, std::string(path.substr(dot + 1))};
    }
    return find_named_target(world, path, location);
}

Status set_value(World& world, std::string_view path, std::string_view value) {
    const std::string name = "--set " + std::string(path);
    const JsonLocation location{name, ""};
    JsonValue json = parse_value(value);
    json.at = {};
    const SetTarget target = LIMN_TRY(find_set_target(world, path));
    switch (target.part) {
    case LevelPart::Resource:
        return set_in_resource(world, *target.info, target.field, json, location);
    case LevelPart::Material: {
        Assets& assets = *world.find_resource<Assets>();
        LIMN_TRY(set_field(
            *target.info, &assets.materials[target.material], target.field, json, location,
            make_name_resolver(world)));
        ++assets.material_version;
        return Done{};
    }
    default:
        return set_in_entities(world, target.entities, *target.info, target.field, json, location);
    }
}

NameResolver make_name_resolver(const World& world) {
    NameResolver names;
    names.asset = [&world](std::string_view kind, std::string_view name, SourcePosition) {
        return find_asset(list_assets(world), kind, name);
    };
    names.entity = [&world](std::string_view name, SourcePosition) -> std::optional<Entity> {
        const std::vector<Entity> entities = find_entities(world, name);
        return entities.empty() ? std::nullopt : std::optional(entities.front());
    };
    names.all = [&world](std::string_view kind) {
        std::vector<std::string_view> all;
        if (kind == "entity") {
            world.query<const Name>().each([&](const Name& name) { all.emplace_back(name.text); });
        } else {
            all = asset_names(list_assets(world), kind);
        }
        return all;
    };
    return names;
}

NameProvider make_name_provider(const World& world) {
    NameProvider names;
    names.asset = [&world](std::string_view kind, std::uint32_t index) {
        std::string found;
        const WorldAssetLists assets = list_assets(world);
        visit_asset_list(assets, kind, [&](const auto& list) {
            found = index < list.size() ? list[index].name : "";
        });
        return found;
    };
    names.entity = [&world](Entity entity) {
        const Name* const name = world.find<Name>(entity);
        return name != nullptr ? name->text : std::string();
    };
    return names;
}

}  // namespace limn
