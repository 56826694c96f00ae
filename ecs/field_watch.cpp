#include "ecs/field_watch.h"

#include "ecs/field_access.h"
#include "ecs/world.h"

#include <cstddef>
#include <utility>

// Techniques: engine.param-notify

namespace limn {
namespace {

void call_handlers(
    World& world, const std::vector<const FieldInfo*>& fields, const ComponentInfo& info,
    FieldNote note) {
    for (const FieldInfo* const field : fields) {
        note.field = field;
        // A handler may add others, which moves them.
        for (std::size_t i = 0; i < world.resource<const FieldWatches>().watches.size(); ++i) {
            const FieldWatches::Watch& watch = world.resource<const FieldWatches>().watches[i];
            if (watch.component == info.id && watch.field == field->name) {
                const FieldHandler handler = watch.handler;
                handler(world, note);
            }
        }
    }
}

}  // namespace

void watch_field(World& world, const ComponentInfo& info, std::string field, FieldHandler handler) {
    LIMN_CHECK(find_field(info.fields, field) != nullptr);
    FieldWatches* const found = world.find_resource<FieldWatches>();
    FieldWatches& all = found != nullptr ? *found : world.insert_resource(FieldWatches{});
    all.watches.push_back({info.id, std::move(field), std::move(handler)});
}

void write_fields(World& world, Entity entity, AnyComponent value) {
    const ComponentInfo& info = value.info();
    LIMN_CHECK(world.has(entity, info.id));
    const FieldWatches* const watches = std::as_const(world).find_resource<FieldWatches>();
    if (watches == nullptr || watches->calling) {
        world.write(entity, info.id, value.data());
        return;
    }
    const std::vector<const FieldInfo*> changed =
        changed_fields(value, AnyComponent::read(world, entity, info));
    world.resource<FieldWatches>().calling = true;
    call_handlers(world, changed, info, {entity, &info, nullptr, FieldPhase::Before});
    world.write(entity, info.id, value.data());
    call_handlers(world, changed, info, {entity, &info, nullptr, FieldPhase::After});
    world.resource<FieldWatches>().calling = false;
}

bool equal_fields(const FieldInfo& field, const void* a, const void* b) {
    const std::size_t count = element_count(field, a);
    bool equal = count == element_count(field, b);
    for (std::size_t i = 0; equal && i < count; ++i) {
        equal = equal_elements(field, element_ptr(field, a, i), element_ptr(field, b, i));
    }
    return equal;
}

std::vector<const FieldInfo*> changed_fields(const AnyComponent& a, const AnyComponent& b) {
    std::vector<const FieldInfo*> changed;
    for (const FieldInfo& field : a.info().fields) {
        if (!equal_fields(field, field_ptr(a.data(), field), field_ptr(b.data(), field))) {
            changed.push_back(&field);
        }
    }
    return changed;
}

}  // namespace limn
