#include "content/app/panels/undo.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/post.h"
#include "ecs/components/surface.h"
#include "ecs/field_access.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <utility>
#include <vector>

namespace limn {

/// Can be disabled.
struct UndoneSwitch {
    int value = 0;
};
template <>
struct ComponentTraits<UndoneSwitch> : DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};

namespace {

PointLight bright(float intensity) {
    PointLight light;
    light.intensity = intensity;
    return light;
}

/// Sets the light's intensity as the inspector does.
void edit_intensity(World& world, UndoStack& stack, Entity lamp, float intensity) {
    Edit edit;
    edit.entity = lamp;
    edit.before = AnyComponent::of(world.get<const PointLight>(lamp));
    world.get<PointLight>(lamp).intensity = intensity;
    edit.after = AnyComponent::of(world.get<const PointLight>(lamp));
    edit.label = "lamp: point_light.intensity";
    stack.record(std::move(edit));
}

}  // namespace

TEST_CASE("undo: a restored value is disabled if the one that it replaces is") {
    World world;
    UndoStack stack;
    const Entity lamp = world.create(UndoneSwitch{2});
    Edit edit;
    edit.entity = lamp;
    edit.before = AnyComponent::of(UndoneSwitch{1});
    edit.after = AnyComponent::of(UndoneSwitch{2});
    stack.record(std::move(edit));
    world.disable<UndoneSwitch>(lamp);
    stack.undo(world);
    CHECK(world.get<const UndoneSwitch>(lamp).value == 1);
    CHECK_FALSE(world.is_enabled<UndoneSwitch>(lamp));
    world.enable<UndoneSwitch>(lamp);
    stack.redo(world);
    CHECK(world.get<const UndoneSwitch>(lamp).value == 2);
    CHECK(world.is_enabled<UndoneSwitch>(lamp));
}

TEST_CASE("undo: edits are undone and redone one by one") {
    World world;
    UndoStack stack;
    const Entity lamp = world.create(bright(1));
    edit_intensity(world, stack, lamp, 2);
    edit_intensity(world, stack, lamp, 3);

    CHECK(stack.undo(world) == "lamp: point_light.intensity");
    CHECK(world.get<const PointLight>(lamp).intensity == 2);
    stack.undo(world);
    CHECK(world.get<const PointLight>(lamp).intensity == 1);
    CHECK(stack.undo(world).empty());
    stack.redo(world);
    stack.redo(world);
    CHECK(world.get<const PointLight>(lamp).intensity == 3);
    CHECK(stack.redo(world).empty());
}

TEST_CASE("undo: a new edit clears the redo history") {
    World world;
    UndoStack stack;
    const Entity lamp = world.create(bright(1));
    edit_intensity(world, stack, lamp, 2);
    stack.undo(world);
    edit_intensity(world, stack, lamp, 5);
    CHECK(stack.redo_count() == 0);
    stack.undo(world);
    CHECK(world.get<const PointLight>(lamp).intensity == 1);
}

TEST_CASE("undo: an extended drag is undone in one step") {
    World world;
    UndoStack stack;
    const Entity lamp = world.create(bright(1));
    edit_intensity(world, stack, lamp, 2);
    Edit more;
    more.entity = lamp;
    more.before = AnyComponent::of(bright(2));
    more.after = AnyComponent::of(bright(9));
    stack.extend(more);
    CHECK(stack.undo_count() == 1);
    stack.undo(world);
    CHECK(world.get<const PointLight>(lamp).intensity == 1);
    stack.redo(world);
    CHECK(world.get<const PointLight>(lamp).intensity == 9);
    // An edit of something else in between stays as it is.
    const Entity other = world.create(bright(3));
    edit_intensity(world, stack, other, 4);
    stack.extend(more);
    CHECK(stack.undo_count() == 3);
    stack.undo(world);
    stack.undo(world);
    CHECK(world.get<const PointLight>(other).intensity == 3);
}

TEST_CASE("undo: an added component is removed, a removed one restored") {
    World world;
    UndoStack stack;
    const Entity lamp = world.create(bright(4));
    Edit removal;
    removal.entity = lamp;
    removal.before = AnyComponent::of(world.get<const PointLight>(lamp));
    world.remove<PointLight>(lamp);
    stack.record(std::move(removal));

    stack.undo(world);
    REQUIRE(world.has<PointLight>(lamp));
    CHECK(world.get<const PointLight>(lamp).intensity == 4);
    stack.redo(world);
    CHECK_FALSE(world.has<PointLight>(lamp));
}

TEST_CASE("undo: edits of a destroyed entity are skipped") {
    World world;
    UndoStack stack;
    const Entity kept = world.create(bright(1));
    const Entity gone = world.create(bright(1));
    edit_intensity(world, stack, kept, 2);
    edit_intensity(world, stack, gone, 3);
    world.destroy(gone);
    stack.undo(world);
    CHECK(world.get<const PointLight>(kept).intensity == 1);
    CHECK(stack.redo_count() == 1);
}

TEST_CASE("undo: resources and materials are restored, too") {
    World world;
    UndoStack stack;
    world.insert_resource(Exposure{});
    world.insert_resource(Assets{}).materials.emplace_back();

    Edit exposure;
    exposure.part = LevelPart::Resource;
    exposure.before = AnyComponent::of(world.resource<Exposure>());
    world.resource<Exposure>().ev = 3;
    exposure.after = AnyComponent::of(world.resource<Exposure>());
    stack.record(std::move(exposure));

    Assets& assets = world.resource<Assets>();
    Edit material;
    material.part = LevelPart::Material;
    material.before = AnyComponent::of(assets.materials[0]);
    assets.materials[0].roughness = 0.1f;
    material.after = AnyComponent::of(assets.materials[0]);
    stack.record(std::move(material));

    const std::uint64_t version = assets.material_version;
    stack.undo(world);
    CHECK(assets.materials[0].roughness == 0.5f);
    CHECK(assets.material_version > version);  // or the renderer would not see it
    stack.undo(world);
    CHECK(world.resource<Exposure>().ev == 0);
}

TEST_CASE("undo: edits that were saved in the level's file are dropped, others are kept") {
    World world;
    UndoStack stack;
    const Entity lamp = world.create(bright(1));
    const Entity other = world.create(bright(1));
    Edit color;
    color.entity = lamp;
    color.before = AnyComponent::of(bright(1));
    color.after = color.before;
    color.after.as<PointLight>().color = {1, 0, 0};
    REQUIRE(apply_edit_value(world, color, color.after));
    stack.record(std::move(color));
    edit_intensity(world, stack, lamp, 2);
    edit_intensity(world, stack, other, 2);
    edit_intensity(world, stack, lamp, 3);
    edit_intensity(world, stack, lamp, 4);
    stack.undo(world);
    REQUIRE(stack.undo_count() == 4);

    LevelChange change;
    change.entity = lamp;
    change.now = AnyComponent::of(bright(3));
    change.fields = {find_field(component_info<PointLight>().fields, "intensity")};
    stack.adopt(std::vector{change});
    CHECK(stack.undo_count() == 2);  // the color, and the other lamp
    CHECK(stack.redo_count() == 0);
    stack.undo(world);
    CHECK(world.get<const PointLight>(other).intensity == 1);
    stack.undo(world);
    CHECK(world.get<const PointLight>(lamp).color == PointLight{}.color);
    CHECK(world.get<const PointLight>(lamp).intensity == 3);  // as the file has it
    stack.redo(world);
    CHECK(world.get<const PointLight>(lamp).color == Vec3(1, 0, 0));
    CHECK(world.get<const PointLight>(lamp).intensity == 3);
}

}  // namespace limn
