#include "content/load/level/level_events.h"

#include "content/load/level/level_hints.h"
#include "ecs/base/text.h"
#include "ecs/components/input.h"
#include "ecs/components/name.h"
#include "ecs/field_access.h"
#include "ecs/hierarchy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

// Techniques: engine.explosion

namespace limn {

namespace {

constexpr std::string_view kKeys[] = {
    "at",    "every",  "times",         "key",     "released",
    "text",  "set",    "set_resources", "impulse", "impulse_resources",
    "spawn", "destroy"};
constexpr double kMaxTime = 1e6;  // [s]
constexpr int kMaxSteps = 1000;   // through an enumeration

std::string event_hint(std::string_view name, const std::string& did_you_mean) {
    return find_resource(name) != nullptr
               ? fmt::format(" ({} is a resource: use \"set_resources\")", in_quotes(name))
               : where_it_belongs(name, did_you_mean);
}

/// Reads the fields that `json` names into action.value, at `offset`. Fields of a struct that are
/// not named keep their values.
Status read_field_edits(
    const JsonValue& json, const std::vector<FieldInfo>& fields, std::uint32_t offset,
    const JsonLocation& at, const NameResolver& names, ScriptAction& action) {
    LIMN_TRY(expect(json, JsonKind::Object, at, "an object with the fields to set"));
    for (const JsonMember& member : json.members) {
        const FieldInfo* const field = find_field(fields, member.key);
        if (field == nullptr) {
            return error_at(
                at, member.at, "the field " + in_quotes(member.key),
                "an existing field" + field_suggestion(fields, member.key));
        }
        const JsonLocation inner = location_in(at, member.key);
        const std::uint32_t inner_offset = offset + field->offset;
        if (field->type == FieldType::Struct && field->shape == FieldShape::One) {
            LIMN_TRY(
                read_field_edits(member.value, field->fields, inner_offset, inner, names, action));
            continue;
        }
        FieldInfo wide = *field;
        if (action.action == EventAction::Impulse && field->shape == FieldShape::One
            && (field->type == FieldType::Enum || field->type == FieldType::Bool)) {
            const double steps =
                LIMN_TRY(expect_number(member.value, -kMaxSteps, kMaxSteps, inner));
            if (steps != std::floor(steps) || steps == 0) {
                return unexpected(
                    member.value, inner, "the number of values to advance: 1, -1 ...");
            }
            action.edits.push_back({field, inner_offset, static_cast<int>(steps)});
            continue;
        }
        if (action.action == EventAction::Impulse) {
            if (number_count(field->type) == 0 || field->shape == FieldShape::List) {
                return error_at(inner, member.at, "a non-numeric field", "a numeric one");
            }
            wide.meta.min = -INFINITY;  // a difference may be negative where the value may not
            wide.meta.max = INFINITY;
        }
        void* const data = static_cast<std::byte*>(action.value.data()) + inner_offset;
        LIMN_TRY(read_field(member.value, wide, data, inner, names));
        action.edits.push_back({field, inner_offset, 0});
    }
    return Done{};
}

struct EventReader {
    const JsonLocation& location;
    const NameResolver& names;
    const ReadPrefab& read_prefab;
    ScriptEvent event;

    Status read_key(const JsonValue& json, const char* name) {
        const JsonLocation here = location_in(location, name);
        const JsonValue& key = json[name];
        for (const char* const time : {"at", "every", "times", "released"}) {
            if (const JsonValue* const other = json.find(time); other != nullptr && other != &key) {
                return error_at(
                    here, other->at, fmt::format("{} with {}", in_quotes(time), in_quotes(name)),
                    "either a time or a key; use two events for both");
            }
        }
        const std::vector<std::string_view>& known = key_names();
        if (std::find(known.begin(), known.end(), key.text) == known.end()) {
            return unexpected(
                key, here,
                "a key such as \"G\", \"7\", \"Left\" or \"Enter\" that the program does "
                "not use");
        }
        event.key = key.text;
        event.on_release = std::string_view(name) == "released";
        return Done{};
    }

    Status read_times(const JsonValue& json) {
        for (const char* const name : {"key", "released"}) {
            if (json.find(name) != nullptr) {
                return read_key(json, name);
            }
        }
        const JsonValue* const at = json.find("at");
        const JsonValue* const every = json.find("every");
        const JsonValue* const times = json.find("times");
        if (at == nullptr) {
            return error_at(
                location, json.at, "no time",
                "\"at\": seconds since the start of the level, or \"key\": one that is pressed");
        }
        event.time = LIMN_TRY(expect_number(*at, 0.0, kMaxTime, location_in(location, "at"), "s"));
        if (every != nullptr) {
            event.every = LIMN_TRY(
                expect_number(*every, 1e-6, kMaxTime, location_in(location, "every"), "s"));
            event.times = std::numeric_limits<std::uint32_t>::max();
        }
        if (times != nullptr) {
            const JsonLocation here = location_in(location, "times");
            const double count = LIMN_TRY(expect_number(*times, 1.0, 1e9, here));
            if (count != std::floor(count) || every == nullptr) {
                return unexpected(
                    *times, here, every == nullptr ? "\"every\" as well" : "a whole number");
            }
            event.times = static_cast<std::uint32_t>(count);
        }
        return Done{};
    }

    Status read_member(const JsonMember& member) {
        const std::string_view key = member.key;
        const JsonLocation at = location_in(location, key);
        if (key == "set") {
            return read_targets(member.value, EventAction::Set, at);
        }
        if (key == "impulse") {
            return read_targets(member.value, EventAction::Impulse, at);
        }
        if (key == "set_resources") {
            return read_resources(member.value, EventAction::Set, at);
        }
        if (key == "impulse_resources") {
            return read_resources(member.value, EventAction::Impulse, at);
        }
        if (key == "spawn") {
            return read_spawns(member.value, at);
        }
        return key == "destroy" ? read_destroys(member.value, at) : Done{};
    }

    Status read_change(
        const JsonMember& member, const ComponentInfo* info, const std::string& hint,
        ScriptAction action, const JsonLocation& at) {
        if (info == nullptr || info->ops.construct_default == nullptr
            || info->ops.construct_copy == nullptr) {
            const char* const noun = action.is_resource ? "resource" : "component";
            return error_at(
                at, member.at, fmt::format("the {} {}", noun, in_quotes(member.key)),
                "one of `limn components`" + event_hint(member.key, hint));
        }
        if (action.action == EventAction::Remove) {
            if (info == &component_info<Parent>() || info == &component_info<Name>()
                || is_internal(*info)) {
                return error_at(
                    at, member.at, "null for the component " + in_quotes(member.key),
                    "a component that a level can have");
            }
            action.value = AnyComponent(*info);
        } else {
            LIMN_TRY(read_edits(member.value, *info, location_in(at, member.key), names, action));
        }
        event.actions.push_back(std::move(action));
        return Done{};
    }

    Result<Entity> find_entity(std::string_view name, SourcePosition at, const JsonLocation& here) {
        const std::optional<Entity> entity = names.entity(name, at);
        if (!entity) {
            return error_at(
                here, at, "the entity " + in_quotes(name),
                "one of the level" + event_hint(name, did_you_mean(name, names.all("entity"))));
        }
        return *entity;
    }

    /// {"lamp": {"point_light": {...}}}
    Status read_targets(const JsonValue& json, EventAction kind, const JsonLocation& at) {
        LIMN_TRY(expect(json, JsonKind::Object, at, "an object: entities by name"));
        for (const JsonMember& target : json.members) {
            const JsonLocation inner = location_in(at, target.key);
            ScriptAction action;
            action.action = kind;
            action.entity = LIMN_TRY(find_entity(target.key, target.at, at));
            LIMN_TRY(
                expect(target.value, JsonKind::Object, inner, "an object: components by name"));
            for (const JsonMember& component : target.value.members) {
                const bool removes =
                    kind == EventAction::Set && component.value.kind == JsonKind::Null;
                action.action = removes ? EventAction::Remove : kind;
                LIMN_TRY(read_change(
                    component, find_component(component.key), component_suggestion(component.key),
                    action, inner));
            }
        }
        return Done{};
    }

    Status read_resources(const JsonValue& json, EventAction kind, const JsonLocation& at) {
        LIMN_TRY(expect(json, JsonKind::Object, at, "an object: resources by name"));
        for (const JsonMember& resource : json.members) {
            ScriptAction action;
            action.action = kind;
            action.is_resource = true;
            LIMN_TRY(read_change(
                resource, find_resource(resource.key), resource_suggestion(resource.key),
                std::move(action), at));
        }
        return Done{};
    }

    Status read_spawns(const JsonValue& json, const JsonLocation& at) {
        LIMN_TRY(expect(json, JsonKind::Array, at, "an array of entities"));
        for (const JsonValue& node : json.items) {
            ScriptAction action;
            action.action = EventAction::Spawn;
            action.prefab = LIMN_TRY(read_prefab(node, at));
            event.actions.push_back(std::move(action));
        }
        return Done{};
    }

    Status read_destroys(const JsonValue& json, const JsonLocation& at) {
        LIMN_TRY(expect(json, JsonKind::Array, at, "an array of names"));
        for (const JsonValue& name : json.items) {
            LIMN_TRY(expect(name, JsonKind::String, at, "a name"));
            ScriptAction action;
            action.action = EventAction::Destroy;
            action.entity = LIMN_TRY(find_entity(name.text, name.at, at));
            event.actions.push_back(std::move(action));
        }
        return Done{};
    }
};

}  // namespace

Status read_edits(
    const JsonValue& json, const ComponentInfo& info, const JsonLocation& location,
    const NameResolver& names, ScriptAction& action) {
    action.value = AnyComponent(info);
    return read_field_edits(json, info.fields, 0, location, names, action);
}

Result<ScriptEvent> read_event(
    const JsonValue& json, const JsonLocation& location, const NameResolver& names,
    const ReadPrefab& read_prefab) {
    const auto time =
        std::find_if(json.members.begin(), json.members.end(), [](const JsonMember& member) {
            return member.key == "time" || member.key == "t" || member.key == "when";
        });
    if (time != json.members.end()) {
        return error_at(
            location, time->at, "the key " + in_quotes(time->key),
            "\"at\": seconds since the start of the level");
    }
    if (const JsonValue* const set = json.find("set"); set != nullptr) {
        LIMN_TRY(expect(
            *set, JsonKind::Object, location_in(location, "set"),
            R"({"entity": {"component": {"field": value}}})"));
    }
    LIMN_TRY(expect_keys(json, location, kKeys));
    EventReader reader{location, names, read_prefab, {}};
    LIMN_TRY(reader.read_times(json));
    for (const JsonMember& member : json.members) {
        LIMN_TRY(reader.read_member(member));
    }
    return std::move(reader.event);
}

}  // namespace limn
