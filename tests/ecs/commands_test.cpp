#include "ecs/base/jobs.h"
#include "ecs/task_scope.h"
#include "ecs/world.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

/// What a system of this file is to do.
struct Plan {
    std::vector<Entity> entities;
    Entity result;
};

void apply(World& world, CommandBuffer& buffer) {
    CommandBuffer* const all[] = {&buffer};
    apply_commands(world, all);
}

}  // namespace

TEST_CASE(
    "commands: nothing happens before the sync point, everything at it"
    * technique("engine.main-loop")) {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const Entity entity = world.create(Position{1, 0, 0});
    const Entity doomed = world.create(Position{});
    commands.create(Label{"new", {1}}, Heat{3});
    commands.add(entity, Velocity{5, 0, 0});
    commands.remove<Position>(entity);
    commands.destroy(doomed);
    CHECK(world.entity_count() == 2);
    CHECK(world.has<Position>(entity));
    CHECK_FALSE(buffer.empty());
    apply(world, buffer);
    CHECK(buffer.empty());
    CHECK(world.entity_count() == 2);
    CHECK_FALSE(world.alive(doomed));
    CHECK_FALSE(world.has<Position>(entity));
    CHECK(world.get<Velocity>(entity).x == 5);
    const auto [label, heat] = world.query<const Label, const Heat>().single();
    CHECK(label.text == "new");
    CHECK(heat.degrees == 3);
}

TEST_CASE("commands: the last value wins, set only replaces") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const Entity a = world.create(Mass{1});
    const Entity b = world.create();
    const Entity c = world.create(Heat{1});
    commands.add(a, Mass{2});
    commands.add(a, Mass{3});
    commands.set(a, Label{"not there", {}});
    commands.set(b, Mass{9});
    commands.add(b, Label{"one", {}});
    commands.set(b, Label{"two", {}});
    commands.remove<Heat>(c);
    commands.set(c, Heat{2});
    commands.add(c, Note{"x"});
    commands.remove<Note>(c);
    apply(world, buffer);
    CHECK(world.get<Mass>(a).value == 3);
    CHECK_FALSE(world.has<Label>(a));
    CHECK_FALSE(world.has<Mass>(b));
    CHECK(world.get<Label>(b).text == "two");
    CHECK_FALSE(world.has<Heat>(c));
    CHECK_FALSE(world.has<Note>(c));
}

TEST_CASE("commands: commands for a destroyed entity are dropped") {
    World world;
    CommandBuffer first;
    CommandBuffer second;
    const Entity gone = world.create(Mass{});
    const Entity doomed = world.create(Mass{});
    world.destroy(gone);
    Commands(first).destroy(gone);
    Commands(first).add(gone, Label{"x", {}});
    Commands(first).destroy(doomed);
    Commands(first).destroy(doomed);
    Commands(second).add(doomed, Label{"y", {}});
    Commands(second).set(doomed, Mass{4});
    Commands(second).remove<Mass>(doomed);
    Commands(second).add(Entity{}, Mass{});
    CommandBuffer* const all[] = {&first, &second};
    apply_commands(world, all);
    CHECK(world.entity_count() == 0);
    CHECK(first.empty());
    CHECK(second.empty());
}

TEST_CASE("commands: an entity moves at most once, whatever the commands") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const Entity entity = world.create(Position{});
    commands.add(entity, Velocity{});
    commands.add<Marked>(entity);
    commands.add(entity, Mass{});
    commands.remove<Velocity>(entity);
    commands.remove<Position>(entity);
    commands.add(entity, Label{"l", {}});
    apply(world, buffer);
    std::uint64_t moves = 0;
    for (const auto& rows : world.archetypes()) {
        moves += rows->rows_moved_in;
    }
    CHECK(moves == 1);
    CHECK(
        world.archetypes().size()
        == 3);  // none, Position, and the last one: no archetypes in between
    CHECK(world.has<Marked>(entity));
    CHECK_FALSE(world.has<Velocity>(entity));
}

TEST_CASE("commands: a created entity can immediately be changed, destroyed and referenced by "
          "components") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const Entity a = commands.create(Mass{1});
    CHECK_FALSE(world.alive(a));
    const Entity b = commands.create(Target{a});
    commands.add(a, Target{b});
    commands.add<Marked>(b);
    const Entity c = commands.create(Label{"never", {}});
    commands.destroy(c);
    apply(world, buffer);
    CHECK(world.entity_count() == 2);
    const Entity final_a = world.query<With<Mass>>().single_entity();
    const Entity final_b = world.query<With<Marked>>().single_entity();
    CHECK(world.get<Target>(final_a).entity == final_b);
    CHECK(world.get<Target>(final_b).entity == final_a);
    CHECK_FALSE(world.alive(a));
}

TEST_CASE("commands: a placeholder of an earlier run is invalid") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const Entity old = commands.create(Mass{1});
    apply(world, buffer);
    const Entity fresh = commands.create(Target{old}, Velocity{});
    commands.add(old, Label{"lost", {}});
    commands.destroy(old);
    apply(world, buffer);
    CHECK(fresh != old);
    CHECK(world.entity_count() == 2);
    CHECK(world.query<const Label>().empty());
    CHECK(std::get<0>(world.query<const Target>().single()).entity.is_null());
}

TEST_CASE("commands: every recorded value is moved or destroyed, once") {
    Counted::living = 0;
    {
        World world;
        CommandBuffer buffer;
        CommandBuffer forgotten;
        const Commands commands(buffer);
        const Entity a = world.create(Counted(1), SparseCounted{});
        const Entity gone = world.create();
        world.destroy(gone);
        commands.add(a, Counted(2));
        commands.add(a, Counted(3));
        commands.add(a, SparseCounted{});
        commands.add(gone, Counted(4));
        commands.set(a, Counted(5));
        const Entity made = commands.create(Counted(6), SparseCounted{});
        commands.remove<Counted>(made);
        const Entity never = commands.create(Counted(7));
        commands.destroy(never);
        commands.add(never, Counted(8));
        apply(world, buffer);
        CHECK(world.get<Counted>(a).value == 5);
        CHECK(Counted::living == 3);  // a has two, made one
        Commands(forgotten).create(Counted(9));
        CHECK(Counted::living == 4);
    }
    CHECK(Counted::living == 0);
}

TEST_CASE("commands: recorded in parallel, they give the same world for any number of threads") {
    static constexpr auto split = [](Query<const Mass> query, Commands commands) {
        commands.create(Label{"first", {}});
        query.par_chunks([&](ChunkView chunk, std::span<const Mass> masses) {
            std::this_thread::sleep_for(
                std::chrono::microseconds(50));  // so that all threads take part
            for (std::uint32_t i = 0; i < chunk.size(); ++i) {
                const int value = static_cast<int>(masses[i].value);
                if (value % 3 == 0) {
                    const Entity child = commands.create(Heat{value}, Target{chunk.entities()[i]});
                    commands.add(chunk.entities()[i], Target{child});
                } else if (value % 5 == 0) {
                    commands.destroy(chunk.entities()[i]);
                }
            }
        });
        commands.create(Label{"middle", {}});
        query.par_each([&](Entity entity, const Mass& mass) {
            if (static_cast<int>(mass.value) % 7 == 0) {
                commands.add(entity, Note{"seven"});
                commands.add<Marked>(entity);
            }
        });
        commands.create(Label{"last", {}});
    };
    const auto result = [&] {
        World world;
        for (int i = 0; i < 20'000; ++i) {
            world.create(Mass{static_cast<double>(i)});
        }
        world.run(split);
        world.run(split);
        std::vector<Entity> all;
        world.each_entity([&](Entity entity) { all.push_back(entity); });
        world.query<const Target>().each(
            [&](Entity, const Target& target) { all.push_back(target.entity); });
        world.query<const Heat>().each([&](Entity entity, const Heat& heat) {
            all.push_back(entity);
            all.push_back({static_cast<std::uint32_t>(heat.degrees), 0});
        });
        return all;
    };
    const int before = thread_count();
    set_thread_count(1);
    const std::vector<Entity> expected = result();
    CHECK(expected.size() > 20'000);
    for (const int threads : {2, 3, 7, 16}) {
        set_thread_count(threads);
        CHECK(result() == expected);
    }
    set_thread_count(before);
}

TEST_CASE("commands: entities get their handles in the order in which they were recorded") {
    static constexpr auto spawn = [](Query<const Mass> query, Commands commands) {
        commands.create(Heat{-1});
        query.par_each(
            [&](const Mass& mass) { commands.create(Heat{static_cast<int>(mass.value)}); });
        commands.create(Heat{1'000'000});
    };
    World world;
    for (int i = 0; i < 5000; ++i) {
        world.create(Mass{static_cast<double>(i)});
    }
    world.run(spawn);
    Entity previous = {0, 0};
    int previous_heat = -2;
    world.query<const Heat>().each([&](Entity entity, const Heat& heat) {
        REQUIRE(entity.index > previous.index);
        REQUIRE(heat.degrees > previous_heat);
        previous = entity;
        previous_heat = heat.degrees;
    });
    CHECK(previous_heat == 1'000'000);
}

TEST_CASE("commands: a parallel loop within a task of another keeps the order") {
    static constexpr auto nested = [](Query<const Position> outer, Query<const Mass> inner,
                                      Commands commands) {
        outer.par_each([&](const Position& position) {
            commands.create(Heat{static_cast<int>(position.x) * 10'000});
            inner.par_each([&](const Mass& mass) {
                commands.create(
                    Heat{static_cast<int>(position.x) * 10'000 + 1 + static_cast<int>(mass.value)});
            });
        });
    };
    World world;
    for (int i = 0; i < 3; ++i) {
        world.create(Position{static_cast<float>(i), 0, 0});
    }
    for (int i = 0; i < 2000; ++i) {
        world.create(Mass{static_cast<double>(i)});
    }
    world.run(nested);
    int previous = -1;
    world.query<const Heat>().each([&](const Heat& heat) {
        REQUIRE(heat.degrees > previous);
        previous = heat.degrees;
    });
    CHECK(previous == 22'000);
    CHECK(world.query<const Heat>().count() == 3 * 2001);
}

TEST_CASE("commands: an entity may be destroyed while it is iterated over") {
    static constexpr auto cull = [](Query<const Mass> query, Commands commands) {
        query.each([&](Entity entity, const Mass& mass) {
            if (mass.value < 500) {
                commands.destroy(entity);
            }
        });
    };
    World world;
    for (int i = 0; i < 3000; ++i) {
        world.create(Mass{static_cast<double>(i)});
    }
    world.run(cull);
    CHECK(world.entity_count() == 2500);
    world.query<const Mass>().each([](const Mass& mass) { REQUIRE(mass.value >= 500); });
}

TEST_CASE("commands: type-erased commands do the same") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const Entity entity = commands.create();
    const Label label{"copied", {1}};
    commands.add_copy(entity, component_id<Label>, &label);
    commands.add_default(entity, component_id<Mass>);
    commands.add_default(entity, component_id<Marked>);
    commands.add_default(entity, component_id<Heat>);
    commands.remove(entity, component_id<Heat>);
    apply(world, buffer);
    const Entity made = world.query<With<Label, Mass, Marked>, Without<Heat>>().single_entity();
    CHECK(world.get<Label>(made).text == "copied");
    CHECK(world.get<Mass>(made).value == 1);
}

TEST_CASE("commands: commands recorded by custom threads have no order, and the sync point stops") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    commands.create(Mass{1});
    std::thread([&] { commands.create(Mass{2}); }).join();
    CHECK(stop_message([&] { apply(world, buffer); }).find("their order is") != std::string::npos);
    buffer.discard();
}

TEST_CASE("commands: commands of several threads are sorted by chunk") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    const auto record = [&](TaskScope place, int value) {
        const TaskScopeGuard scope(place);
        commands.create(Heat{value});
        commands.create(Heat{value + 1});
    };
    const auto elsewhere = [&](TaskScope place, int value) {
        std::thread([&] { record(place, value); }).join();
    };
    record({0, 0}, 0);
    elsewhere({1, 3}, 50);
    record({1, 2}, 40);
    elsewhere({3, 1}, 70);
    elsewhere({1, 1}, 30);
    record({2, 0}, 60);
    record({3, 2}, 80);
    apply(world, buffer);
    Entity previous;
    std::vector<int> order;
    world.query<const Heat>().each([&](Entity entity, const Heat& heat) {
        CHECK((order.empty() || entity.index == previous.index + 1));
        previous = entity;
        order.push_back(heat.degrees);
    });
    CHECK(order == std::vector<int>{0, 1, 30, 31, 40, 41, 50, 51, 60, 61, 70, 71, 80, 81});
}
