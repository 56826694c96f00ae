#include "content/load/level_events.h"

#include "ecs/base/text.h"
#include "ecs/field_access.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace limn {

namespace {

const std::vector<std::string_view> kKeys = {"at",      "every", "times",  "set", "set_resources",
                                             "impulse", "spawn", "destroy"};
constexpr double kLatest = 1e6;  // [s]

struct EventReader {
    const JsonPlace& place;
    const FindNames& names;
    const ReadPrefab& read_prefab;
    ScriptEvent event;

    Status
    read_number(const JsonValue& json, const char* key, double min, double max, double& out) {
        const bool good = json.kind == JsonKind::Number && json.number >= min && json.number <= max;
        if (!good) {
            return error_at(
                {place.file, place.path + '.' + key}, json.at, describe(json),
                fmt::format("a number {} .. {}", min, max));
        }
        out = json.number;
        return Done{};
    }

    Status read_times(const JsonValue& json);
    Status read_member(const JsonMember& member);
    Status read_edits(
        const JsonValue& json, const std::vector<FieldInfo>& fields, std::uint32_t offset,
        const JsonPlace& at, ScriptAction& action);
    Status read_change(
        const JsonMember& member, const ComponentInfo* info, const std::string& hint,
        ScriptAction action, const JsonPlace& at);
    Status read_targets(const JsonValue& json, EventAction kind, const char* key);
    Status read_resources(const JsonValue& json);
    Status read_spawns(const JsonValue& json);
    Status read_destroys(const JsonValue& json);
    Result<Entity> find_entity(std::string_view name, SourcePosition at, const char* key);
};

Status EventReader::read_times(const JsonValue& json) {
    const JsonValue* const at = json.find("at");
    if (at == nullptr) {
        return error_at(place, json.at, "no time", "\"at\": seconds since the level began");
    }
    Status status = read_number(*at, "at", 0.0, kLatest, event.time);
    const JsonValue* const every = json.find("every");
    const JsonValue* const times = json.find("times");
    if (status && every != nullptr) {
        status = read_number(*every, "every", 1e-6, kLatest, event.every);
        event.times = std::numeric_limits<std::uint32_t>::max();
    }
    if (status && times != nullptr) {
        double count = 1.0;
        status = read_number(*times, "times", 1.0, 1e9, count);
        if (status && (count != std::floor(count) || every == nullptr)) {
            return error_at(
                {place.file, place.path + ".times"}, times->at, describe(*times),
                every == nullptr ? "\"every\" beside it" : "a whole number");
        }
        event.times = static_cast<std::uint32_t>(count);
    }
    return status;
}

/// The fields that `json` names, read into action.value. An object for a struct names fields of it,
/// so that the others stay.
Status EventReader::read_edits(
    const JsonValue& json, const std::vector<FieldInfo>& fields, std::uint32_t offset,
    const JsonPlace& at, ScriptAction& action) {
    if (json.kind != JsonKind::Object) {
        return error_at(at, json.at, describe(json), "an object with the fields to set");
    }
    for (const JsonMember& member : json.members) {
        const FieldInfo* const field = find_field(fields, member.key);
        if (field == nullptr) {
            return error_at(
                at, member.at, "the field " + in_quotes(member.key),
                "one that it has" + field_suggestion(fields, member.key));
        }
        const JsonPlace inner{at.file, at.path + '.' + member.key};
        const std::uint32_t inner_offset = offset + field->offset;
        if (field->type == FieldType::Struct && field->shape == FieldShape::One) {
            const Status status =
                read_edits(member.value, field->fields, inner_offset, inner, action);
            if (!status) {
                return status;
            }
            continue;
        }
        FieldInfo wide = *field;
        const bool is_impulse = action.action == EventAction::Impulse;
        if (is_impulse) {
            if (number_count(field->type) == 0 || field->shape == FieldShape::List) {
                return error_at(inner, member.at, "a field without numbers", "one that can grow");
            }
            wide.meta.min = -INFINITY;  // a difference may be negative where the value may not
            wide.meta.max = INFINITY;
        }
        void* const data = static_cast<std::byte*>(action.value.data()) + inner_offset;
        const Status status = read_field(member.value, wide, data, inner, names);
        if (!status) {
            return status;
        }
        action.edits.push_back({field, inner_offset});
    }
    return Done{};
}

Status EventReader::read_change(
    const JsonMember& member, const ComponentInfo* info, const std::string& hint,
    ScriptAction action, const JsonPlace& at) {
    const char* const noun = action.is_resource ? "resource" : "component";
    if (info == nullptr || info->ops.construct_default == nullptr
        || info->ops.construct_copy == nullptr) {
        return error_at(
            at, member.at, fmt::format("the {} {}", noun, in_quotes(member.key)),
            fmt::format("one of `limn components`{}", hint));
    }
    action.value = AnyComponent(*info);
    const JsonPlace inner{at.file, at.path + '.' + member.key};
    const Status status = read_edits(member.value, info->fields, 0, inner, action);
    if (status) {
        event.actions.push_back(std::move(action));
    }
    return status;
}

Result<Entity> EventReader::find_entity(std::string_view name, SourcePosition at, const char* key) {
    const std::optional<Entity> entity = names.entity(name, at);
    if (!entity) {
        return error_at(
            {place.file, place.path + '.' + key}, at, "the entity " + in_quotes(name),
            "one of the level" + did_you_mean(name, names.all("entity")));
    }
    return *entity;
}

/// {"lamp": {"point_light": {...}}}
Status EventReader::read_targets(const JsonValue& json, EventAction kind, const char* key) {
    const JsonPlace at{place.file, place.path + '.' + key};
    if (json.kind != JsonKind::Object) {
        return error_at(at, json.at, describe(json), "an object: entities by name");
    }
    for (const JsonMember& target : json.members) {
        const Result<Entity> entity = find_entity(target.key, target.at, key);
        if (!entity) {
            return entity.error();
        }
        const JsonPlace inner{at.file, at.path + '.' + target.key};
        if (target.value.kind != JsonKind::Object) {
            return error_at(
                inner, target.value.at, describe(target.value), "an object: components by name");
        }
        for (const JsonMember& component : target.value.members) {
            ScriptAction action;
            action.action = kind;
            action.entity = *entity;
            const Status status = read_change(
                component, find_component(component.key), component_suggestion(component.key),
                std::move(action), inner);
            if (!status) {
                return status;
            }
        }
    }
    return Done{};
}

Status EventReader::read_resources(const JsonValue& json) {
    const JsonPlace at{place.file, place.path + ".set_resources"};
    if (json.kind != JsonKind::Object) {
        return error_at(at, json.at, describe(json), "an object: resources by name");
    }
    for (const JsonMember& resource : json.members) {
        ScriptAction action;
        action.is_resource = true;
        const Status status = read_change(
            resource, find_resource(resource.key), resource_suggestion(resource.key),
            std::move(action), at);
        if (!status) {
            return status;
        }
    }
    return Done{};
}

Status EventReader::read_spawns(const JsonValue& json) {
    const JsonPlace at{place.file, place.path + ".spawn"};
    if (json.kind != JsonKind::Array) {
        return error_at(at, json.at, describe(json), "an array of entities");
    }
    for (const JsonValue& node : json.items) {
        Result<Prefab> prefab = read_prefab(node, at);
        if (!prefab) {
            return prefab.error();
        }
        ScriptAction& action = event.actions.emplace_back();
        action.action = EventAction::Spawn;
        action.prefab = *std::move(prefab);
    }
    return Done{};
}

Status EventReader::read_destroys(const JsonValue& json) {
    if (json.kind != JsonKind::Array) {
        return error_at(
            {place.file, place.path + ".destroy"}, json.at, describe(json), "an array of names");
    }
    for (const JsonValue& name : json.items) {
        if (name.kind != JsonKind::String) {
            return error_at(
                {place.file, place.path + ".destroy"}, name.at, describe(name), "a name");
        }
        const Result<Entity> entity = find_entity(name.text, name.at, "destroy");
        if (!entity) {
            return entity.error();
        }
        ScriptAction& action = event.actions.emplace_back();
        action.action = EventAction::Destroy;
        action.entity = *entity;
    }
    return Done{};
}

Status EventReader::read_member(const JsonMember& member) {
    const std::string_view key = member.key;
    if (key == "set") {
        return read_targets(member.value, EventAction::Set, "set");
    }
    if (key == "impulse") {
        return read_targets(member.value, EventAction::Impulse, "impulse");
    }
    if (key == "set_resources") {
        return read_resources(member.value);
    }
    if (key == "spawn") {
        return read_spawns(member.value);
    }
    if (key == "destroy") {
        return read_destroys(member.value);
    }
    if (key == "at" || key == "every" || key == "times") {
        return Done{};
    }
    return error_at(
        place, member.at, "the key " + in_quotes(key),
        fmt::format("one of {}", fmt::join(kKeys, " ")) + did_you_mean(key, kKeys));
}

}  // namespace

Result<ScriptEvent> read_event(
    const JsonValue& json, const JsonPlace& place, const FindNames& names,
    const ReadPrefab& read_prefab) {
    if (json.kind != JsonKind::Object) {
        return error_at(place, json.at, describe(json), "an object");
    }
    EventReader reader{place, names, read_prefab, {}};
    Status status = reader.read_times(json);
    for (const JsonMember& member : json.members) {
        if (!status) {
            break;
        }
        status = reader.read_member(member);
    }
    if (!status) {
        return status.error();
    }
    return std::move(reader.event);
}

}  // namespace limn
