#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/environment.h"
#include "ecs/components/input.h"
#include "ecs/components/lifetime.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/path.h"
#include "ecs/components/post.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "systems/script_system.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <string_view>
#include <utility>
#include <vector>

namespace limn::script_system_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

/// Runs the step with this number.
void run_step(World& world, std::uint64_t frame) {
    world.insert_resource(FrameTime{
        .step = kStep,
        .time = static_cast<double>(frame + 1) * static_cast<double>(kStep),
        .frame = frame});
    run_events(world);
    if (world.find_resource<Input>() != nullptr) {
        world.run(keep_input);
    }
}

const FieldInfo& field_of(const ComponentInfo& info, std::string_view name) {
    for (const FieldInfo& field : info.fields) {
        if (field.name == name) {
            return field;
        }
    }
    REQUIRE(false);
    return info.fields.front();
}

/// An action on one field of a component.
template <typename T>
ScriptAction
change(EventAction action, Entity entity, const T& value, std::string_view field_name) {
    ScriptAction change;
    change.action = action;
    change.entity = entity;
    change.value = AnyComponent::of(value);
    const FieldInfo& field = field_of(component_info<T>(), field_name);
    change.edits.push_back({&field, field.offset});
    return change;
}

ScriptEvent event_at(double time, ScriptAction action) {
    ScriptEvent event;
    event.time = time;
    event.actions.push_back(std::move(action));
    return event;
}

}  // namespace

TEST_CASE("script: an event is executed once, in the step that begins at its time") {
    ScriptEvent event;
    event.time = 0.5;
    std::vector<std::uint64_t> due;
    for (std::uint64_t frame = 0; frame < 100; ++frame) {
        if (is_due(event, frame, kStep)) {
            due.push_back(frame);
        }
    }
    CHECK(due == std::vector<std::uint64_t>{30});
}

TEST_CASE("script: a repeated event keeps its interval and ends after its count") {
    ScriptEvent event;
    event.time = 0.1;
    event.every = 0.05;
    event.times = 4;
    std::vector<std::uint64_t> due;
    for (std::uint64_t frame = 0; frame < 100; ++frame) {
        if (is_due(event, frame, kStep)) {
            due.push_back(frame);
        }
    }
    CHECK(due == std::vector<std::uint64_t>{6, 9, 12, 15});
    event.every = 1e-6;  // never more than once a step
    due.clear();
    for (std::uint64_t frame = 0; frame < 100; ++frame) {
        if (is_due(event, frame, kStep)) {
            due.push_back(frame);
        }
    }
    CHECK(due == std::vector<std::uint64_t>{6, 7, 8, 9});
    event.times = 0;
    CHECK_FALSE(is_due(event, 6, kStep));
}

TEST_CASE("script: what removes a component does so once, and leaves other entities alone") {
    World world;
    const Entity lamp = world.create(PointLight{});
    const Entity other = world.create(PointLight{});
    const Entity gone = world.create(PointLight{});
    const auto remove = [](Entity entity) {
        ScriptAction action;
        action.action = EventAction::Remove;
        action.entity = entity;
        action.value = AnyComponent::of(PointLight{});
        return action;
    };
    world.insert_resource(EventList{
        {event_at(0, remove(lamp)), event_at(0, remove(gone)), event_at(0, remove(lamp))}});
    world.insert_resource(FrameTime{.step = kStep});
    world.destroy(gone);
    run_events(world);
    CHECK_FALSE(world.has<PointLight>(lamp));
    CHECK(world.has<PointLight>(other));
}

TEST_CASE("script: set changes the named fields and no others") {
    World world;
    const Entity lamp = world.create(PointLight{.intensity = 3, .radius = 7});
    const PointLight wanted{.intensity = 9, .radius = 1};
    world.insert_resource(
        EventList{{event_at(0, change(EventAction::Set, lamp, wanted, "intensity"))}});
    run_step(world, 0);
    CHECK(world.get<const PointLight>(lamp).intensity == 9.0f);
    CHECK(world.get<const PointLight>(lamp).radius == 7.0f);
}

TEST_CASE("script: set adds the component that is missing, impulse does not") {
    World world;
    const Entity a = world.create(Transform{});
    const Entity b = world.create(Transform{});
    world.insert_resource(EventList{
        {event_at(0, change(EventAction::Set, a, Spin{.speed = 2}, "speed")),
         event_at(0, change(EventAction::Impulse, b, Spin{.speed = 2}, "speed"))}});
    run_step(world, 0);
    CHECK(world.get<const Spin>(a).speed == 2.0f);
    CHECK(world.find<Spin>(b) == nullptr);
}

TEST_CASE("script: set replaces strings, lists and resources") {
    World world;
    CameraPath path;
    path.keys.resize(3);
    path.keys[2].time = 5;
    const Entity entity = world.create(Name{"old"}, CameraPath{});
    ScriptAction resource = change(EventAction::Set, Entity{}, Exposure{.ev = 4}, "ev");
    resource.is_resource = true;
    world.insert_resource(Exposure{.curve = ToneCurve::Linear});
    world.insert_resource(EventList{
        {event_at(0, change(EventAction::Set, entity, Name{"new"}, "text")),
         event_at(0, change(EventAction::Set, entity, path, "keys")),
         event_at(0, std::move(resource))}});
    run_step(world, 0);
    CHECK(world.get<const Name>(entity).text == "new");
    REQUIRE(world.get<const CameraPath>(entity).keys.size() == 3);
    CHECK(world.get<const CameraPath>(entity).keys[2].time == 5.0f);
    CHECK(world.resource<Exposure>().ev == 4.0f);
    CHECK(world.resource<Exposure>().curve == ToneCurve::Linear);
}

TEST_CASE("script: an impulse adds within the range, and rotates rotations further") {
    World world;
    const Quat quarter = glm::angleAxis(radians(90.0f), Vec3(0, 1, 0));
    const Entity entity = world.create(
        Transform{.position = {1, 2, 3}, .rotation = quarter}, PointLight{.intensity = 3});
    ScriptEvent event;
    event.actions.push_back(
        change(EventAction::Impulse, entity, Transform{.position = {0, -5, 1}}, "position"));
    event.actions.push_back(
        change(EventAction::Impulse, entity, Transform{.rotation = quarter}, "rotation"));
    event.actions.push_back(
        change(EventAction::Impulse, entity, PointLight{.intensity = -10}, "intensity"));
    world.insert_resource(EventList{{event}});
    run_step(world, 0);
    const Transform& t = world.get<const Transform>(entity);
    CHECK(t.position == Vec3(1, -3, 4));
    CHECK(std::abs(glm::dot(t.rotation, quarter * quarter)) == test::near(1.0f));
    CHECK(world.get<const PointLight>(entity).intensity == 0.0f);  // not below its range
}

TEST_CASE("script: an impulse steps through enumerations, around both ends, and toggles bools") {
    World world;
    const Entity lamp = world.create(PointLight{.enabled = false});
    world.insert_resource(Exposure{.metering = Metering::Auto});
    const auto stepped = [&world, lamp](int steps) {
        ScriptAction metering = change(EventAction::Impulse, Entity{}, Exposure{}, "metering");
        metering.is_resource = true;
        metering.edits[0].steps = steps;
        ScriptAction enabled = change(EventAction::Impulse, lamp, PointLight{}, "enabled");
        enabled.edits[0].steps = steps;
        world.insert_resource(EventList{{event_at(0, metering), event_at(0, enabled)}});
        run_step(world, 0);
    };
    stepped(1);
    CHECK(world.resource<Exposure>().metering == Metering::Manual);  // the first after the last
    CHECK(world.get<const PointLight>(lamp).enabled);
    stepped(-2);
    CHECK(world.resource<Exposure>().metering == Metering::Key);
    CHECK(world.get<const PointLight>(lamp).enabled);
}

TEST_CASE("script: spawned prefabs are complete and new each time; destroy includes descendants") {
    World world;
    Prefab prefab;
    prefab.entities.resize(2);
    prefab.entities[0].components.push_back(AnyComponent::of(Name{"stone"}));
    prefab.entities[1].components.push_back(AnyComponent::of(Parent{prefab_entity(0), 0}));
    ScriptEvent spawn;
    spawn.every = static_cast<double>(kStep);
    spawn.times = 3;
    spawn.actions.emplace_back();
    spawn.actions[0].action = EventAction::Spawn;
    spawn.actions[0].prefab = prefab;
    const Entity old = world.create(Transform{});
    const Entity below = world.create(Transform{}, Parent{old});
    ScriptEvent destroy;
    destroy.every = static_cast<double>(kStep);
    destroy.times = 2;  // the second time there is nothing left
    destroy.actions.emplace_back();
    destroy.actions[0].action = EventAction::Destroy;
    destroy.actions[0].entity = old;
    world.insert_resource(EventList{{spawn, destroy}});
    for (std::uint64_t frame = 0; frame < 10; ++frame) {
        run_step(world, frame);
    }
    CHECK(world.query<const Name>().count() == 3);
    CHECK(world.query<const Parent>().count() == 3);
    CHECK_FALSE(world.alive(old));
    CHECK_FALSE(world.alive(below));
}

TEST_CASE("script: a key that is held over many frames of a window is pressed once") {
    World world;
    const Entity entity = world.create(Transform{});
    ScriptEvent event;
    event.key = "G";
    event.actions.push_back(
        change(EventAction::Impulse, entity, Transform{.position = {0, 1, 0}}, "position"));
    world.insert_resource(EventList{{event}});
    world.insert_resource(Input{});
    Input held;
    set_action(held, key_action("G"));
    std::uint64_t step = 0;
    for (const int steps : {2, 0, 1, 3}) {  // of a frame
        take_input(world.resource<Input>(), held);
        for (int i = 0; i < steps; ++i) {
            run_step(world, step++);
        }
    }
    CHECK(world.get<const Transform>(entity).position.y == 1.0f);
}

TEST_CASE(
    "script: a key event is executed once per press or release, however long the key is held") {
    World world;
    const Entity pressed = world.create(Transform{});
    const Entity released = world.create(Transform{});
    const auto up = [&](Entity entity) {
        return change(EventAction::Impulse, entity, Transform{.position = {0, 1, 0}}, "position");
    };
    ScriptEvent press = event_at(0, up(pressed));
    press.key = "G";
    ScriptEvent release = event_at(0, up(released));
    release.key = "G";
    release.on_release = true;
    world.insert_resource(EventList{{press, release}});
    world.insert_resource(Input{});
    const bool held[] = {false, true, true, true, false, false, true, false, true, true};
    const float presses[] = {0, 1, 1, 1, 1, 1, 2, 2, 3, 3};
    const float releases[] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 2};
    for (std::uint64_t frame = 0; frame < 10; ++frame) {
        set_action(world.resource<Input>(), key_action("G"), held[frame] ? 1.0f : 0.0f);
        set_action(world.resource<Input>(), key_action("H"), 1);  // of nothing
        run_step(world, frame);
        CHECK(world.get<const Transform>(pressed).position.y == presses[frame]);
        CHECK(world.get<const Transform>(released).position.y == releases[frame]);
    }
}

TEST_CASE(
    "lifetime: an entity is destroyed with its descendants when its time is up, others stay") {
    World world;
    const Entity short_lived = world.create(Lifetime{0.09f});
    const Entity child = world.create(Parent{short_lived}, Lifetime{0.09f});
    const Entity long_lived = world.create(Lifetime{10});
    world.insert_resource(FrameTime{.step = kStep});
    for (int step = 1; step <= 6; ++step) {
        CHECK(world.alive(short_lived));
        end_lifetimes(world);
    }
    CHECK_FALSE(world.alive(short_lived));
    CHECK_FALSE(world.alive(child));
    CHECK(world.alive(long_lived));
}

TEST_CASE("script: actions on a destroyed entity do nothing") {
    World world;
    const Entity entity = world.create(Spin{});
    world.insert_resource(
        EventList{{event_at(0, change(EventAction::Set, entity, Spin{.speed = 2}, "speed"))}});
    world.destroy(entity);
    run_step(world, 0);
    CHECK(world.entity_count() == 0);
    World empty;
    run_events(empty);  // without a list or a time
}

TEST_CASE("script: a camera follows its path and its target, and stops if asked to") {
    World world;
    CameraPath path;
    path.keys.resize(2);
    path.keys[1].time = 2;
    path.keys[1].position = {4, 0, 0};
    path.aim = CameraAim::Target;
    WorldTransform there;
    there.world = affine_from({2, 0, -9}, Quat(1, 0, 0, 0), Vec3(1));
    path.target = world.create(there);
    const Entity camera = world.create(Transform{.scale = {2, 2, 2}}, path);
    path.enabled = false;
    const Entity resting = world.create(Transform{.position = {7, 7, 7}}, path);
    world.insert_resource(FrameTime{.time = 1.0});
    world.run(update_camera_paths);
    const Transform& t = world.get<const Transform>(camera);
    CHECK(t.position.x == test::near(2.0f));
    CHECK((t.rotation * Vec3(0, 0, -1)).z == test::near(-1.0f));
    CHECK(t.scale == Vec3(2));
    CHECK(world.get<const Transform>(resting).position == Vec3(7));
    world.destroy(path.target);
    world.run(update_camera_paths);  // then it looks where the first key does
    CHECK(std::isfinite(world.get<const Transform>(camera).rotation.w));
}

TEST_CASE("script: an entity moved by an event jumps; one that is only set in motion does not") {
    const auto marks = [](auto&& component, EventAction action, std::string_view field) {
        World world;
        const Entity entity = world.create(Transform{}, component);
        world.insert_resource(EventList{{event_at(0, change(action, entity, component, field))}});
        run_step(world, 0);
        return std::pair(world.has<Teleport>(entity), world.has<PoseCut>(entity));
    };
    constexpr std::pair kNone(false, false);
    constexpr std::pair kTeleport(true, false);
    constexpr std::pair kPoseCut(false, true);
    using enum EventAction;
    World world;
    const Entity box = world.create(Transform{});
    world.insert_resource(
        EventList{{event_at(0, change(Set, box, Transform{.position = {1, 0, 0}}, "position"))}});
    run_step(world, 0);
    CHECK(world.has<Teleport>(box));
    CHECK(world.get<const Transform>(box).position.x == 1);
    CHECK(marks(Sway{}, Set, "center") == kTeleport);
    CHECK(marks(Sway{}, Impulse, "center") == kTeleport);
    CHECK(marks(CameraPath{}, Set, "enabled") == kTeleport);
    CHECK(marks(PathFollower{}, Set, "distance") == kTeleport);
    CHECK(marks(PathFollower{}, Set, "speed") == kNone);
    CHECK(marks(Spin{}, Set, "speed") == kNone);
    CHECK(marks(Camera{}, Set, "active") == kNone);
    CHECK(marks(ClipPlayer{}, Set, "time") == kPoseCut);
    CHECK(marks(ClipPlayer{}, Set, "clip") == kPoseCut);
    CHECK(marks(ClipPlayer{}, Set, "speed") == kNone);
    CHECK(marks(MorphWeights{}, Set, "weights") == kPoseCut);
}

}  // namespace limn::script_system_test
