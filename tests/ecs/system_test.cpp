#include "ecs/param_group.h"
#include "ecs/system.h"
#include "ecs/world.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

void integrate(
    Query<Position, const Velocity, Optional<const Mass>, Without<Frozen>> query,
    Res<const Mass> scale) {
    query.each([&](Position& position, const Velocity& velocity, const Mass*) {
        position.x += velocity.x * static_cast<float>(scale->value);
    });
}
void spawn(Query<const Position, Changed<Velocity>>, Res<Label> label, Commands commands) {
    label->text += "s";
    commands.create(Marked{});
}
void everything(World& world) {
    world.create(Velocity{});
}
void inspect(const World& world, Res<Label> label) {
    label->numbers.push_back(static_cast<int>(world.entity_count()));
}

/// A group of two parameters.
struct SpeedLog {
    Query<const Velocity> moving;
    Res<Label> label;
};

std::vector<ComponentId> ids(std::vector<ComponentId> list) {
    std::sort(list.begin(), list.end());
    return list;
}

}  // namespace

template <>
struct limn::SystemParam<SpeedLog> : ParamGroup<SpeedLog, Query<const Velocity>, Res<Label>> {};

TEST_CASE("system: its accesses follow from its parameters") {
    const SystemAccess a = access_of<integrate>();
    CHECK(a.writes == ids({component_id<Position>}));
    CHECK(a.reads == ids({component_id<Velocity>, component_id<Mass>}));
    CHECK(a.resource_reads == ids({component_id<Mass>}));
    CHECK_FALSE(a.commands);
    CHECK_FALSE(a.exclusive);
    const SystemAccess b = access_of<spawn>();
    CHECK(b.reads == ids({component_id<Position>, component_id<Velocity>}));
    CHECK(b.resource_writes == ids({component_id<Label>}));
    CHECK(b.commands);
    CHECK(access_of<everything>().exclusive);
    CHECK(access_of<inspect>().reads_all);
}

TEST_CASE("system: two systems conflict if one writes what the other accesses") {
    static constexpr auto read = [](Query<const Position>) {};
    static constexpr auto write = [](Query<Position>) {};
    static constexpr auto other = [](Query<Velocity, With<Position>>) {};
    static constexpr auto resource = [](Res<Label>) {};
    static constexpr auto all = [](const World&) {};
    static constexpr auto exclusive = [](World&) {};
    const auto conflict = [](const auto& a, const auto& b) {
        const System first = make_system("a", a);
        const System second = make_system("b", b);
        CHECK(
            first.access().conflicts_with(second.access())
            == second.access().conflicts_with(first.access()));
        return first.access().conflicts_with(second.access());
    };
    CHECK_FALSE(conflict(read, read));
    CHECK(conflict(read, write));
    CHECK(conflict(write, write));
    CHECK_FALSE(conflict(write, other));
    CHECK_FALSE(conflict(write, resource));
    CHECK(conflict(resource, resource));
    CHECK_FALSE(conflict(all, read));
    CHECK(conflict(all, write));
    CHECK(conflict(all, resource));
    CHECK(conflict(exclusive, read));
}

TEST_CASE("system: a group of parameters counts as its members") {
    static constexpr auto log_speeds = [](Query<const Position> positions, SpeedLog log) {
        log.label->numbers.push_back(static_cast<int>(positions.count()));
        log.label->numbers.push_back(static_cast<int>(log.moving.count()));
    };
    System system = make_system("log_speeds", log_speeds);
    CHECK(system.access().reads == ids({component_id<Position>, component_id<Velocity>}));
    CHECK(system.access().resource_writes == ids({component_id<Label>}));
    CHECK(system.queries().size() == 2);
    World world;
    world.insert_resource(Label{});
    world.create_many(5, Position{});
    world.create_many(2, Position{}, Velocity{});
    run_system(world, system);
    CHECK(world.resource<Label>().numbers == std::vector<int>{7, 2});
}

TEST_CASE("system: is named after its function") {
    CHECK(make_system<integrate>().name() == "integrate");
    CHECK(make_system<everything>().name() == "everything");
}

TEST_CASE("system: run passes its parameters and applies its commands afterwards") {
    World world;
    world.insert_resource(Mass{2});
    world.insert_resource(Label{});
    const Entity moving = world.create(Position{1, 0, 0}, Velocity{3, 0, 0});
    const Entity frozen = world.create(Position{1, 0, 0}, Velocity{3, 0, 0}, Frozen{});
    world.run(integrate);
    CHECK(world.get<Position>(moving).x == 7);
    CHECK(world.get<Position>(frozen).x == 1);
    world.run(spawn);
    CHECK(world.query<With<Marked>>().count() == 1);
    CHECK(world.resource<Label>().text == "s");
    world.run(everything);
    world.run(inspect);
    CHECK(world.resource<Label>().numbers == std::vector<int>{4});
}

TEST_CASE("system: a lambda with captures is a system, too") {
    World world;
    world.create_many(5, Position{});
    int count = 0;
    world.run([&](Query<const Position> query) { count += static_cast<int>(query.count()); });
    CHECK(count == 5);
}

TEST_CASE("system: a structural change inside a system stops, unless it is exclusive") {
    World world;
    world.create(Position{});
    const auto change = [&](Query<const Position>) { world.create(Position{}); };
    CHECK(stop_message([&] { world.run(change); }).find("structural change") != std::string::npos);
    world.run([](World& w) { w.create(Position{}); });
    CHECK(world.entity_count() == 2);
}

TEST_CASE("system: in another world a system finds everything changed") {
    World first;
    World second;
    first.create(Position{1});
    second.create(Position{2});
    for (int i = 0; i < 100; ++i) {
        static_cast<void>(first.version());  // its clock is ahead
    }
    float sum = 0;
    System system = make_system("sum", [&](Query<const Position, Changed<Position>> positions) {
        sum = 0;
        positions.each([&](const Position& position) { sum += position.x; });
    });
    run_system(first, system);
    CHECK(sum == 1);
    run_system(second, system);
    CHECK(sum == 2);
    run_system(second, system);
    CHECK(sum == 0);
    run_system(first, system);
    CHECK(sum == 1);
}

TEST_CASE("system: a resource that is missing is named") {
    World world;
    CHECK(stop_message([&] { world.run(integrate); }).find("mass") != std::string::npos);
}

TEST_CASE("system: an exclusive one may query and run others") {
    World world;
    world.insert_resource(Mass{1});
    world.create(Position{}, Velocity{1, 0, 0});
    world.run([](World& w) {
        w.run(integrate);
        w.query<Position>().each([](Position& position) { position.x *= 10; });
    });
    CHECK(std::get<0>(world.query<const Position>().single()).x == 10);
}
