#include "content/app/edit_json.h"

#include "content/load/json_document.h"
#include "content/load/set_value.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace limn {
namespace {

/// The member `key` of an object, added as an empty object where it has none.
JsonValue& member(JsonValue& object, const std::string& key) {
    const auto found =
        std::find_if(object.members.begin(), object.members.end(), [&](const JsonMember& m) {
            return m.key == key;
        });
    return found != object.members.end()
               ? found->value
               : object.members.emplace_back(JsonMember{key, {}, json_object()}).value;
}

void set_member(JsonValue& object, const std::string& key, JsonValue value) {
    member(object, key) = std::move(value);
}

const Name* name_of(const World& world, Entity entity) {
    const Name* const name = world.alive(entity) ? world.find<Name>(entity) : nullptr;
    return name != nullptr && !name->text.empty() ? name : nullptr;
}

}  // namespace

std::string component_as_json(const World& world, const ComponentInfo& info, const void* value) {
    return '"' + info.name
           + "\": " + write_json(write_component(info, value, make_name_provider(world)));
}

std::string entity_as_json(const World& world, Entity entity) {
    JsonValue object = json_object();
    if (const Name* const name = name_of(world, entity)) {
        set_member(object, "name", json_of(std::string_view(name->text)));
    }
    for (const ComponentId id : world.components_of(entity)) {
        const ComponentInfo& info = component_info(id);
        if (!info.is_registered || !info.saved || info.fields.empty() || id == component_id<Name>) {
            continue;
        }
        const AnyComponent value = AnyComponent::read(world, entity, info);
        set_member(
            object, info.name, write_component(info, value.data(), make_name_provider(world)));
    }
    return write_json(object);
}

std::string edits_as_json(const World& world, std::span<const Edit> edits) {
    JsonValue patch = json_object();
    const NameProvider names = make_name_provider(world);
    for (const Edit& edit : edits) {
        const ComponentInfo& info = edit.before.is_empty() ? edit.after.info() : edit.before.info();
        switch (edit.kind) {
        case EditKind::Component:
            if (const Name* const name = name_of(world, edit.entity)) {
                JsonValue value;
                if (world.has(edit.entity, info.id)) {
                    const AnyComponent now = AnyComponent::read(world, edit.entity, info);
                    value = write_component(info, now.data(), names);
                }
                set_member(
                    member(member(patch, "entities"), name->text), info.name, std::move(value));
            }
            break;
        case EditKind::Resource:
            if (const void* const now = world.find_resource(info.id)) {
                set_member(
                    member(patch, "resources"), info.name, write_component(info, now, names));
            }
            break;
        case EditKind::Material: {
            const auto* const assets = world.find_resource<Assets>();
            if (assets != nullptr && edit.material < assets->materials.size()) {
                const Material& now = assets->materials[edit.material];
                set_member(
                    member(patch, "materials"), now.name, write_component(info, &now, names));
            }
            break;
        }
        }
    }
    return write_json(patch);
}

}  // namespace limn
