#include "ecs/world.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

// What the system below saw in its last run; a system has no other way out.
struct Seen {
    std::vector<Entity> entities;
};

void look(Query<const Position, Changed<Position>> query, Res<Seen> seen) {
    seen->entities.clear();
    query.each([&](Entity entity, const Position&) { seen->entities.push_back(entity); });
}
void look_at_heat(Query<const Heat, Changed<Heat>> query, Res<Seen> seen) {
    seen->entities.clear();
    query.each([&](Entity entity, const Heat&) { seen->entities.push_back(entity); });
}
void look_at_either(Query<With<Position>, Changed<Mass, Heat>> query, Res<Seen> seen) {
    seen->entities.clear();
    query.each([&](Entity entity) { seen->entities.push_back(entity); });
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
std::size_t seen_by(World& world, F system) {
    world.run(system);
    return world.resource<Seen>().entities.size();
}

}  // namespace

TEST_CASE(
    "change: a system sees everything the first time and then nothing until something changes") {
    World world;
    world.insert_resource(Seen{});
    world.create_many(3000, Position{});
    CHECK(seen_by(world, look) == 3000);
    CHECK(seen_by(world, look) == 0);
    world.run(read_only);
    CHECK(seen_by(world, look) == 0);
    world.run(move_all);
    CHECK(seen_by(world, look) == 3000);
    CHECK(seen_by(world, look) == 0);
}

TEST_CASE("change: reading does not count, writing counts for the chunk of the row and no other") {
    World world;
    world.insert_resource(Seen{});
    const std::vector<Entity> entities = world.create_many(3000, Position{}, Mass{});
    world.run(look);
    static_cast<void>(world.get<const Position>(entities[5]));
    static_cast<void>(std::as_const(world).get<Position>(entities[5]));
    static_cast<void>(std::as_const(world).find(entities[5], component_id<Position>));
    world.query<const Position>().each([](const Position&) {});
    world.get<Mass>(entities[5]).value = 1;
    CHECK(seen_by(world, look) == 0);
    world.get<Position>(entities[1500]).x = 1;
    world.run(look);
    const std::vector<Entity> seen = world.resource<Seen>().entities;
    CHECK(seen == std::vector<Entity>(entities.begin() + 1024, entities.begin() + 2048));
    static_cast<void>(world.find(entities[2999], component_id<Position>));
    CHECK(seen_by(world, look) == 3000 - 2048);
}

TEST_CASE("change: a system does not see what it wrote itself, others do") {
    static constexpr auto touch = [](Query<Position, Changed<Position>> query, Res<Seen> seen) {
        seen->entities.clear();
        query.each([&](Entity entity, Position& position) {
            position.x += 1;
            seen->entities.push_back(entity);
        });
    };
    World world;
    world.insert_resource(Seen{});
    world.create_many(10, Position{});
    CHECK(seen_by(world, touch) == 10);
    CHECK(seen_by(world, touch) == 0);
    CHECK(seen_by(world, look) == 10);
    world.run(move_all);
    CHECK(seen_by(world, touch) == 10);
}

TEST_CASE("change: writing between runs is seen by the next run") {
    World world;
    world.insert_resource(Seen{});
    const Entity entity = world.create(Position{});
    CHECK(seen_by(world, look) == 1);
    for (int i = 0; i < 5; ++i) {
        world.get<Position>(entity).x = 1;
        CHECK(seen_by(world, look) == 1);
        CHECK(seen_by(world, look) == 0);
    }
}

TEST_CASE("change: rows that come, go or move count for their chunks") {
    World world;
    world.insert_resource(Seen{});
    std::vector<Entity> entities = world.create_many(4096, Position{});
    world.run(look);
    const Entity added = world.create(Position{});
    CHECK(seen_by(world, look) == 1);
    world.destroy(added);
    CHECK(seen_by(world, look) == 0);
    world.destroy(entities[0]);  // the last takes its place
    CHECK(seen_by(world, look) == 1024 + 1023);
    world.add<Marked>(entities[2000]);
    CHECK(seen_by(world, look) == 1024 + 1022 + 1);
}

TEST_CASE("change: writing a part in parallel marks that part") {
    World world;
    world.insert_resource(Seen{});
    world.create_many(5000, Position{});
    world.create_many(2500, Position{}, Marked{});
    world.run(look);
    world.run(move_marked);
    CHECK(seen_by(world, look) == 2500);
}

TEST_CASE("change: mark_unchanged takes back what a span announced") {
    World world;
    world.insert_resource(Seen{});
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
    CHECK(seen_by(world, look) == 1024);
    CHECK(seen_by(world, look) == 0);
}

TEST_CASE("change: queries outside of systems say since when") {
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
    world.insert_resource(Seen{});
    std::vector<Entity> entities = world.create_many(3000, Position{}, Heat{});
    CHECK(seen_by(world, look_at_heat) == 3000);
    CHECK(seen_by(world, look_at_heat) == 0);
    static_cast<void>(world.get<const Heat>(entities[0]));
    CHECK(seen_by(world, look_at_heat) == 0);
    world.get<Heat>(entities[0]).degrees = 1;
    CHECK(seen_by(world, look_at_heat) == 1024);
    static_cast<void>(std::as_const(world).find(entities[2999], component_id<Heat>));
    CHECK(seen_by(world, look_at_heat) == 0);
    static_cast<void>(world.find(entities[2999], component_id<Heat>));
    CHECK(seen_by(world, look_at_heat) == 3000 - 2048);
    world.query<Heat>().each([](Heat&) {});
    CHECK(seen_by(world, look_at_heat) == 3000);
    world.get<Position>(entities[0]).x = 2;
    CHECK(seen_by(world, look_at_heat) == 0);
}

TEST_CASE("change: Changed<A, B> is either of them, of entities that have both") {
    World world;
    world.insert_resource(Seen{});
    const Entity both = world.create(Position{}, Mass{}, Heat{});
    world.create(Position{}, Mass{});
    CHECK(seen_by(world, look_at_either) == 1);
    CHECK(seen_by(world, look_at_either) == 0);
    world.get<Mass>(both).value = 2;
    CHECK(seen_by(world, look_at_either) == 1);
    world.get<Heat>(both).degrees = 2;
    CHECK(seen_by(world, look_at_either) == 1);
    world.get<Position>(both).x = 2;
    CHECK(seen_by(world, look_at_either) == 0);
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

TEST_CASE("change: resources know whether they were written") {
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

TEST_CASE("change: a resource that is asked for as const is not written") {
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
        world.insert_resource(Seen{});
        world.create_many(2000, Position{});
        CHECK(seen_by(world, look) == 2000);
        for (int i = 0; i < 40; ++i) {
            CHECK(seen_by(world, look) == 0);
            world.run(move_all);
            CHECK(seen_by(world, look) == 2000);
        }
    }
}

TEST_CASE("change: what changed very long ago never becomes new again") {
    World world;
    world.insert_resource(Seen{});
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
        CHECK(seen_by(world, look) == 0);
    }
    world.get<Position>(entity).x = 1;
    CHECK(seen_by(world, look) == 1);
}

TEST_CASE("change: a value that commands replace has changed") {
    static constexpr auto replace_both = [](Query<const Position> query, Commands commands) {
        query.each([&](Entity entity, const Position&) {
            commands.set(entity, Position{1, 2, 3});
            commands.add(entity, Heat{5});
        });
    };
    World world;
    world.insert_resource(Seen{});
    world.create(Position{}, Heat{});
    world.run(look);
    world.run(look_at_heat);
    CHECK(seen_by(world, look) + seen_by(world, look_at_heat) == 0);
    world.run(replace_both);
    CHECK(seen_by(world, look) == 1);
    CHECK(seen_by(world, look_at_heat) == 1);
    CHECK(seen_by(world, look) + seen_by(world, look_at_heat) == 0);
}
