#include "ecs/world.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

// Entities that the systems below found in their last run; a system has no other output.
struct Found {
    std::vector<Entity> entities;
};

void look(Query<const Position, Changed<Position>> query, Res<Found> found) {
    found->entities.clear();
    query.each([&](Entity entity, const Position&) { found->entities.push_back(entity); });
}
void look_at_heat(Query<const Heat, Changed<Heat>> query, Res<Found> found) {
    found->entities.clear();
    query.each([&](Entity entity, const Heat&) { found->entities.push_back(entity); });
}
void look_at_either(Query<With<Position>, Changed<Mass, Heat>> query, Res<Found> found) {
    found->entities.clear();
    query.each([&](Entity entity) { found->entities.push_back(entity); });
}
void read_only(Query<const Position> query) {
    query.each([](const Position&) {});
}
void move_all(Query<Position> query) {
    query.each([](Position& position) { position.x += 1; });
}
void move_marked(Query<Position, With<Marked>> query) {
    query.par_each([](Position& position) { position.x += 1; });
}

template <typename F>
std::size_t found_by(World& world, F system) {
    world.run(system);
    return world.resource<Found>().entities.size();
}

}  // namespace

TEST_CASE(
    "change: a system finds everything in its first run, then nothing until something changes") {
    World world;
    world.insert_resource(Found{});
    world.create_many(3000, Position{});
    CHECK(found_by(world, look) == 3000);
    CHECK(found_by(world, look) == 0);
    world.run(read_only);
    CHECK(found_by(world, look) == 0);
    world.run(move_all);
    CHECK(found_by(world, look) == 3000);
    CHECK(found_by(world, look) == 0);
}

TEST_CASE("change: reading does not count, writing counts for the chunk of the row and no other") {
    World world;
    world.insert_resource(Found{});
    const std::vector<Entity> entities = world.create_many(3000, Position{}, Mass{});
    world.run(look);
    static_cast<void>(world.get<const Position>(entities[5]));
    static_cast<void>(std::as_const(world).get<Position>(entities[5]));
    static_cast<void>(std::as_const(world).find(entities[5], component_id<Position>));
    world.query<const Position>().each([](const Position&) {});
    world.get<Mass>(entities[5]).value = 1;
    CHECK(found_by(world, look) == 0);
    world.get<Position>(entities[1500]).x = 1;
    world.run(look);
    const std::vector<Entity> found = world.resource<Found>().entities;
    CHECK(found == std::vector<Entity>(entities.begin() + 1024, entities.begin() + 2048));
    static_cast<void>(world.find(entities[2999], component_id<Position>));
    CHECK(found_by(world, look) == 3000 - 2048);
}

TEST_CASE("change: a system does not find its own writes, others do") {
    static constexpr auto touch = [](Query<Position, Changed<Position>> query, Res<Found> found) {
        found->entities.clear();
        query.each([&](Entity entity, Position& position) {
            position.x += 1;
            found->entities.push_back(entity);
        });
    };
    World world;
    world.insert_resource(Found{});
    world.create_many(10, Position{});
    CHECK(found_by(world, touch) == 10);
    CHECK(found_by(world, touch) == 0);
    CHECK(found_by(world, look) == 10);
    world.run(move_all);
    CHECK(found_by(world, touch) == 10);
}

TEST_CASE("change: writes between runs are found by the next run") {
    World world;
    world.insert_resource(Found{});
    const Entity entity = world.create(Position{});
    CHECK(found_by(world, look) == 1);
    for (int i = 0; i < 5; ++i) {
        world.get<Position>(entity).x = 1;
        CHECK(found_by(world, look) == 1);
        CHECK(found_by(world, look) == 0);
    }
}

TEST_CASE("change: added, removed and moved rows count as changes of their chunks") {
    World world;
    world.insert_resource(Found{});
    std::vector<Entity> entities = world.create_many(4096, Position{});
    world.run(look);
    const Entity added = world.create(Position{});
    CHECK(found_by(world, look) == 1);
    world.destroy(added);
    CHECK(found_by(world, look) == 0);
    world.destroy(entities[0]);  // replaced by the last row
    CHECK(found_by(world, look) == 1024 + 1023);
    world.add<Marked>(entities[2000]);
    CHECK(found_by(world, look) == 1024 + 1022 + 1);
}

TEST_CASE("change: writing a part in parallel marks only that part") {
    World world;
    world.insert_resource(Found{});
    world.create_many(5000, Position{});
    world.create_many(2500, Position{}, Marked{});
    world.run(look);
    world.run(move_marked);
    CHECK(found_by(world, look) == 2500);
}

TEST_CASE("change: mark_unchanged undoes the change of a span") {
    World world;
    world.insert_resource(Found{});
    world.create_many(3000, Position{});
    world.run(look);
    static constexpr auto touch_one_chunk = [](Query<Position> query) {
        query.chunks([](ChunkView chunk, std::span<Position> positions) {
            if (chunk.index() == 1) {
                positions[0].x = 1;
            } else {
                chunk.mark_unchanged<Position>();
            }
        });
    };
    world.run(touch_one_chunk);
    CHECK(found_by(world, look) == 1024);
    CHECK(found_by(world, look) == 0);
}

TEST_CASE("change: queries outside of systems specify since when") {
    World world;
    const std::vector<Entity> entities = world.create_many(2000, Position{});
    CHECK(world.query<Changed<Position>>().count() == 2000);
    const std::uint32_t before = world.version();
    CHECK(world.query<Changed<Position>>().since(before).count() == 0);
    world.get<Position>(entities[1999]).x = 1;
    CHECK(world.query<Changed<Position>>().since(before).count() == 2000 - 1024);
    CHECK(world.query<Changed<Position>>().since(world.version()).count() == 0);
    const World& constant = world;
    CHECK(constant.query<Changed<Position>>().since(before).count() == 2000 - 1024);
    std::vector<bool> changed;
    world.query<const Position>().chunks([&](ChunkView chunk, std::span<const Position>) {
        changed.push_back(chunk.changed_since<Position>(before));
    });
    CHECK(changed == std::vector<bool>{false, true});
}

TEST_CASE("change: sparse components have versions too") {
    World world;
    world.insert_resource(Found{});
    std::vector<Entity> entities = world.create_many(3000, Position{}, Heat{});
    CHECK(found_by(world, look_at_heat) == 3000);
    CHECK(found_by(world, look_at_heat) == 0);
    static_cast<void>(world.get<const Heat>(entities[0]));
    CHECK(found_by(world, look_at_heat) == 0);
    world.get<Heat>(entities[0]).degrees = 1;
    CHECK(found_by(world, look_at_heat) == 1024);
    static_cast<void>(std::as_const(world).find(entities[2999], component_id<Heat>));
    CHECK(found_by(world, look_at_heat) == 0);
    static_cast<void>(world.find(entities[2999], component_id<Heat>));
    CHECK(found_by(world, look_at_heat) == 3000 - 2048);
    world.query<Heat>().each([](Heat&) {});
    CHECK(found_by(world, look_at_heat) == 3000);
    world.get<Position>(entities[0]).x = 2;
    CHECK(found_by(world, look_at_heat) == 0);
}

TEST_CASE("change: Changed<A, B> matches a change of either, for entities with both") {
    World world;
    world.insert_resource(Found{});
    const Entity both = world.create(Position{}, Mass{}, Heat{});
    world.create(Position{}, Mass{});
    CHECK(found_by(world, look_at_either) == 1);
    CHECK(found_by(world, look_at_either) == 0);
    world.get<Mass>(both).value = 2;
    CHECK(found_by(world, look_at_either) == 1);
    world.get<Heat>(both).degrees = 2;
    CHECK(found_by(world, look_at_either) == 1);
    world.get<Position>(both).x = 2;
    CHECK(found_by(world, look_at_either) == 0);
}

TEST_CASE("change: several Changed terms must all hold") {
    World world;
    const Entity entity = world.create(Position{}, Mass{});
    const std::uint32_t before = world.version();
    const auto count = [&] {
        return world.query<Changed<Position>, Changed<Mass>>().since(before).count();
    };
    world.get<Mass>(entity).value = 2;
    CHECK(count() == 0);
    world.get<Position>(entity).x = 2;
    CHECK(count() == 1);
}

TEST_CASE("change: resources record whether they were written") {
    struct Result {
        std::vector<bool> changed;
    };
    static constexpr auto watch = [](Res<const Mass> mass, Res<Result> result) {
        result->changed.push_back(mass.changed());
    };
    static constexpr auto write = [](Res<Mass> mass) { mass->value += 1; };
    static constexpr auto read = [](Res<const Mass>) {};
    World world;
    world.insert_resource(Mass{});
    world.insert_resource(Result{});
    world.run(watch);
    world.run(watch);
    world.run(read);
    world.run(watch);
    world.run(write);
    world.run(watch);
    CHECK(world.resource<Result>().changed == std::vector<bool>{true, false, false, true});
}

TEST_CASE("change: a resource requested as const is not written") {
    World world;
    world.insert_resource(Mass{3});
    const std::uint32_t before = world.resource_version(component_id<Mass>);
    static_cast<void>(world.version());  // what is written now is later
    CHECK(world.resource<const Mass>().value == 3);
    CHECK(world.find_resource<const Mass>() != nullptr);
    CHECK(world.find_resource<const Position>() == nullptr);
    CHECK(world.resource_version(component_id<Mass>) == before);
    world.resource<Mass>().value = 4;
    CHECK(world.resource_version(component_id<Mass>) != before);
}

TEST_CASE("change: versions may wrap around") {
    for (const std::uint32_t start : {0x7ffffff0u, 0xfffffff0u}) {
        World world;
        world.set_version(start);
        world.insert_resource(Found{});
        world.create_many(2000, Position{});
        CHECK(found_by(world, look) == 2000);
        for (int i = 0; i < 40; ++i) {
            CHECK(found_by(world, look) == 0);
            world.run(move_all);
            CHECK(found_by(world, look) == 2000);
        }
    }
}

TEST_CASE("change: an old change never counts as new again") {
    World world;
    world.insert_resource(Found{});
    const Entity entity = world.create(Position{}, Heat{});
    world.run(look);
    std::uint32_t version = world.version();
    for (int i = 0; i < 40; ++i) {
        version += 1u << 27;
        world.set_version(version);
        const std::uint32_t recently = world.version() - 1000;
        world.run(read_only);
        CHECK(world.query<Changed<Position>>().since(recently).count() == 0);
        CHECK(world.query<Changed<Heat>>().since(recently).count() == 0);
        CHECK(world.query<Changed<Position>>().count() == 1);
        CHECK(found_by(world, look) == 0);
    }
    world.get<Position>(entity).x = 1;
    CHECK(found_by(world, look) == 1);
}

TEST_CASE("change: a value replaced by commands has changed") {
    static constexpr auto replace_both = [](Query<const Position> query, Commands commands) {
        query.each([&](Entity entity, const Position&) {
            commands.set(entity, Position{1, 2, 3});
            commands.add(entity, Heat{5});
        });
    };
    World world;
    world.insert_resource(Found{});
    world.create(Position{}, Heat{});
    world.run(look);
    world.run(look_at_heat);
    CHECK(found_by(world, look) + found_by(world, look_at_heat) == 0);
    world.run(replace_both);
    CHECK(found_by(world, look) == 1);
    CHECK(found_by(world, look_at_heat) == 1);
    CHECK(found_by(world, look) + found_by(world, look_at_heat) == 0);
}
