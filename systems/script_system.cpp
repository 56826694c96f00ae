#include "systems/script_system.h"

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/input.h"
#include "ecs/components/lifetime.h"
#include "ecs/components/path.h"
#include "ecs/components/rotation_track.h"
#include "ecs/field_access.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <algorithm>
#include <vector>

namespace limn {

namespace {

/// Advances an enumeration or bool; the first value follows the last one.
void step_field(const FieldInfo& field, void* to, int steps) {
    if (field.type == FieldType::Bool) {
        *static_cast<bool*>(to) = *static_cast<bool*>(to) != (steps % 2 != 0);
        return;
    }
    const int count = static_cast<int>(field.values.size());
    const int now = static_cast<int>(get_unsigned(field, to));
    const int next = ((now + steps) % count + count) % count;
    (void)set_enum(field, to, field.values[static_cast<std::size_t>(next)]).ok();  // it exists
}

/// Adds the field at `by` to the one at `to`.
void add_to_field(const FieldInfo& field, void* to, const void* by) {
    if (field.shape == FieldShape::List) {
        return;
    }
    for (std::size_t i = 0; i < element_count(field, to); ++i) {
        void* const target = element_ptr(field, to, i);
        const void* const amount = element_ptr(field, by, i);
        if (field.type == FieldType::Quat) {
            Quat& rotation = *static_cast<Quat*>(target);
            rotation = glm::normalize(*static_cast<const Quat*>(amount) * rotation);
            continue;
        }
        for (int lane = 0; lane < number_count(field.type); ++lane) {
            const double sum = get_number(field, target, lane) + get_number(field, amount, lane);
            const double clamped = std::clamp(sum, field.meta.min, field.meta.max);
            // A value that the type cannot represent is not stored.
            (void)set_number(field, target, clamped, lane).ok();
        }
    }
}

void apply_edits(const ScriptAction& action, void* target) {
    for (const FieldEdit& edit : action.edits) {
        void* const to = static_cast<std::byte*>(target) + edit.offset;
        const void* const from = static_cast<const std::byte*>(action.value.data()) + edit.offset;
        if (action.action == EventAction::Set) {
            copy_field(*edit.field, to, from);
        } else if (edit.steps != 0) {
            step_field(*edit.field, to, edit.steps);
        } else {
            add_to_field(*edit.field, to, from);
        }
    }
}

/// Fields of a component that determine the position or pose of its entity.
struct PlacingFields {
    ComponentId component;
    std::vector<std::string_view> names;  ///< empty: all
    bool of_pose = false;
};

const std::vector<PlacingFields>& placing_fields() {
    static const std::vector<PlacingFields> kFields = {
        {component_id<Transform>, {}},
        {component_id<Sway>, {}},
        {component_id<CameraPath>, {}},
        {component_id<RotationTrack>, {}},
        {component_id<JointAttachment>, {}},
        {component_id<PathFollower>, {"path", "distance", "offset", "level"}},
        {component_id<ClipPlayer>, {"clip", "time"}, true},
        {component_id<MorphPlayer>, {}, true},
        {component_id<MorphWeights>, {}, true},
        {component_id<Deformers>, {}, true}};
    return kFields;
}

/// After an edit: an entity that was moved by it has no velocity.
void mark_jump(World& world, const ScriptAction& action) {
    for (const PlacingFields& fields : placing_fields()) {
        const auto moves = [&fields](const FieldEdit& edit) {
            return fields.names.empty()
                   || std::ranges::find(fields.names, edit.field->name) != fields.names.end();
        };
        if (fields.component == action.value.info().id
            && std::ranges::any_of(action.edits, moves)) {
            fields.of_pose ? (void)world.add(action.entity, PoseCut{})
                           : (void)world.add(action.entity, Teleport{});
        }
    }
}

/// Does nothing if the resource or entity does not exist. Set adds a missing component.
void edit_target(World& world, const ScriptAction& action) {
    const ComponentInfo& info = action.value.info();
    if (action.is_resource) {
        if (void* const resource = world.find_resource(info.id); resource != nullptr) {
            apply_edits(action, resource);
        }
        return;
    }
    if (!world.alive(action.entity)) {
        return;
    }
    if (action.action == EventAction::Set) {
        world.add(action.entity, info.id);
    }
    // On a copy, since some storages have no addressable components.
    AnyComponent component = AnyComponent::read(world, action.entity, info);
    if (!component.is_empty()) {
        apply_edits(action, component.data());
        world.write(action.entity, info.id, component.data());
        mark_jump(world, action);
    }
}

void run_action(World& world, const ScriptAction& action) {
    switch (action.action) {
    case EventAction::Set:
    case EventAction::Impulse:
        edit_target(world, action);
        break;
    case EventAction::Spawn:
        (void)spawn(world, action.prefab);
        break;
    case EventAction::Destroy:
        if (world.alive(action.entity)) {
            destroy_tree(world, action.entity);
        }
        break;
    case EventAction::Remove:
        if (world.alive(action.entity) && world.has(action.entity, action.value.info().id)) {
            world.remove(action.entity, action.value.info().id);
        }
        break;
    }
}

bool has_key(const ScriptEvent& event, const Input& input) {
    if (event.key.empty()) {
        return false;
    }
    const std::string action = key_action(event.key);
    return event.on_release ? is_released(input, action) : is_pressed(input, action);
}

}  // namespace

void run_events(World& world) {
    const FrameTime* const time = std::as_const(world).find_resource<FrameTime>();
    const EventList* const list = std::as_const(world).find_resource<EventList>();
    if (time == nullptr || list == nullptr) {
        return;
    }
    const Input* const input = std::as_const(world).find_resource<Input>();
    const Input keys = input != nullptr ? *input : Input{};
    for (const ScriptEvent& event : list->events) {
        if (is_due(event, time->frame, time->step) || has_key(event, keys)) {
            for (const ScriptAction& action : event.actions) {
                run_action(world, action);
            }
        }
    }
}

void keep_input(Res<Input> input) {
    input->before = input->actions;
}

void end_lifetimes(World& world) {
    const FrameTime* const time = std::as_const(world).find_resource<FrameTime>();
    std::vector<Entity> ended;
    world.query<Lifetime>().each([&](Entity entity, Lifetime& lifetime) {
        lifetime.left -= time != nullptr ? time->step : 0.0f;
        if (!(lifetime.left > 0)) {
            ended.push_back(entity);
        }
    });
    for (const Entity entity : ended) {
        if (world.alive(entity)) {  // not a descendant of another one
            destroy_tree(world, entity);
        }
    }
}

void update_camera_paths(
    Query<const CameraPath, Transform> cameras, Query<const WorldTransform> targets,
    Res<const FrameTime> time, OptionalRes<StepJumps> jumps) {
    const auto step = static_cast<double>(time->step);
    cameras.each([&](Entity entity, const CameraPath& path, Transform& transform) {
        if (!path.enabled || path.keys.empty()) {
            return;
        }
        Vec3 target(0);
        if (path.aim == CameraAim::Target) {
            const WorldTransform* const followed = targets.find<const WorldTransform>(path.target);
            target = followed != nullptr ? transform_point(followed->world, Vec3(0))
                                         : path.keys.front().look_at;
        }
        const CameraPose pose = camera_pose(path, time->time, target);
        transform.position = pose.position;
        transform.rotation = pose.rotation;
        const std::optional<double> cut = camera_cut(path, time->time - step, time->time);
        if (cut && jumps) {
            const double at = (*cut - (time->time - step)) / step;
            jumps->requests.push_back({entity, static_cast<float>(std::clamp(at, 0.0, 1.0))});
        }
    });
}

}  // namespace limn
