#include "ecs/base/jobs.h"
#include "ecs/world.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <atomic>
#include <numeric>
#include <thread>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

/// Entities of six archetypes; every third has Heat.
std::vector<Entity> fill(World& world, int count) {
    std::vector<Entity> entities;
    for (int i = 0; i < count; ++i) {
        const Entity entity = world.create(Mass{static_cast<double>(i)});
        if (i % 2 == 0) {
            world.add(entity, Position{static_cast<float>(i), 0, 0});
        }
        if (i % 5 == 0) {
            world.add<Marked>(entity);
        }
        if (i % 7 == 0) {
            world.add(entity, Velocity{1, 2, 3});
        }
        if (i % 3 == 0) {
            world.add(entity, Heat{i});
        }
        entities.push_back(entity);
    }
    return entities;
}

template <typename... Terms, typename Predicate>
void check_matches(World& world, const std::vector<Entity>& entities, const Predicate& predicate) {
    std::size_t expected = 0;
    for (std::size_t i = 0; i < entities.size(); ++i) {
        const bool matches = predicate(static_cast<int>(i));
        expected += matches ? 1 : 0;
        CHECK(world.query<Terms...>().contains(entities[i]) == matches);
    }
    CHECK(world.query<Terms...>().count() == expected);
    CHECK(world.query<Terms...>().empty() == (expected == 0));
}

}  // namespace

TEST_CASE("query: visits exactly the entities that its terms describe") {
    World world;
    const std::vector<Entity> all = fill(world, 500);
    check_matches<const Mass>(world, all, [](int) { return true; });
    check_matches<const Position>(world, all, [](int i) { return i % 2 == 0; });
    check_matches<Position, const Velocity>(world, all, [](int i) { return i % 14 == 0; });
    check_matches<const Mass, With<Marked>>(world, all, [](int i) { return i % 5 == 0; });
    check_matches<With<Marked, Position>>(world, all, [](int i) { return i % 10 == 0; });
    check_matches<const Mass, Without<Marked, Velocity>>(
        world, all, [](int i) { return i % 5 != 0 && i % 7 != 0; });
    check_matches<Optional<const Position>, const Velocity>(
        world, all, [](int i) { return i % 7 == 0; });
    check_matches<const Heat>(world, all, [](int i) { return i % 3 == 0; });
    check_matches<const Mass, Heat, With<Position>>(world, all, [](int i) { return i % 6 == 0; });
    check_matches<const Mass, Without<Heat>>(world, all, [](int i) { return i % 3 != 0; });
    check_matches<const Mass, With<Heat>, Without<Marked>>(
        world, all, [](int i) { return i % 3 == 0 && i % 5 != 0; });
    check_matches<const Mass, Optional<Heat>>(world, all, [](int) { return true; });
    check_matches<const Note>(world, all, [](int) { return false; });
    check_matches<const Label>(world, all, [](int) { return false; });
}

TEST_CASE("query: without terms it visits every entity") {
    World world;
    fill(world, 100);
    world.create();
    std::size_t visited = 0;
    world.query<>().each([&](Entity entity) { visited += world.alive(entity) ? 1 : 0; });
    CHECK(visited == 101);
    CHECK(world.query<>().count() == 101);
}

TEST_CASE("query: archetypes that appear later are found") {
    World world;
    world.create(Position{});
    const auto query = world.query<const Position>();
    CHECK(query.count() == 1);
    world.create(Position{}, Velocity{});
    world.create(Velocity{});
    CHECK(query.count() == 2);
    world.create(Position{}, Mass{}, Marked{});
    CHECK(query.count() == 3);
}

TEST_CASE("query: each passes the entity's own components, writable unless const") {
    World world;
    const std::vector<Entity> all = fill(world, 300);
    world
        .query<
            const Mass, Velocity, Optional<const Position>, Optional<Heat>,
            Optional<const Marked>>()
        .each([&](Entity entity, const Mass& mass, Velocity& velocity, const Position* position,
                  Heat* heat, const Marked* marked) {
            const int i = static_cast<int>(mass.value);
            CHECK(entity == all[static_cast<std::size_t>(i)]);
            CHECK(velocity.y == 2);
            CHECK((position != nullptr) == (i % 2 == 0));
            CHECK((heat != nullptr) == (i % 3 == 0));
            CHECK((marked != nullptr) == (i % 5 == 0));
            velocity.x = static_cast<float>(i);
            if (heat != nullptr) {
                heat->degrees = -i;
            }
        });
    for (std::size_t i = 0; i < all.size(); i += 7) {
        CHECK(world.get<Velocity>(all[i]).x == static_cast<float>(i));
        if (i % 3 == 0) {
            CHECK(world.get<Heat>(all[i]).degrees == -static_cast<int>(i));
        }
    }
}

TEST_CASE("query: the order is that of archetypes and rows, and the same every time") {
    World world;
    fill(world, 3000);
    const auto visit = [&] {
        std::vector<Entity> order;
        world.query<const Mass>().each(
            [&](Entity entity, const Mass&) { order.push_back(entity); });
        return order;
    };
    std::vector<Entity> expected;
    for (const auto& rows : world.archetypes()) {
        if (rows->has(component_id<Mass>)) {
            expected.insert(expected.end(), rows->entities().begin(), rows->entities().end());
        }
    }
    CHECK(visit() == expected);
    CHECK(visit() == visit());
    std::vector<Entity> heated;
    world.query<const Mass, const Heat>().each(
        [&](Entity entity, const Mass&, const Heat&) { heated.push_back(entity); });
    const auto set = world.sparse_sets()[0]->entities();
    CHECK(std::equal(heated.begin(), heated.end(), set.begin(), set.end()));
}

TEST_CASE("query: archetypes that do not match the query do not change its order") {
    const auto visit = [](bool with_others) {
        World world;
        std::vector<double> order;
        double next = 0;
        const auto some = [&](auto... tags) {
            for (int i = 0; i < 5; ++i) {
                world.create(Mass{next++}, tags...);
            }
        };
        const auto others = [&](auto... parts) {
            if (with_others) {
                world.destroy(world.create(Label{}));
                world.create_many(1500, Velocity{}, parts...);
            }
        };
        const auto query = world.query<const Mass>();
        others();
        some(Position{});
        others(Marked{});
        some(Marked{});
        query.each([](const Mass&) {});  // knows the archetypes so far
        others(Frozen{});
        some(Frozen{}, Position{});
        others(Marked{}, Frozen{});
        query.each([&](const Mass& mass) { order.push_back(mass.value); });
        return order;
    };
    CHECK(visit(false).size() == 15);
    CHECK(visit(true) == visit(false));
}

TEST_CASE("query: chunks cut each archetype every 1024 rows") {
    for (const std::uint32_t count :
         {1u, 1023u, 1024u, 1025u, 2047u, 2048u, 2049u, 5119u, 5120u, 5121u}) {
        World world;
        world.create_many(count, Position{1, 0, 0});
        world.create_many(7, Position{1, 0, 0}, Marked{});
        std::vector<std::uint32_t> sizes;
        std::uint32_t offset = 0;
        world.query<Position>().chunks([&](ChunkView chunk, std::span<Position> positions) {
            CHECK(chunk.size() == positions.size());
            CHECK(chunk.entities().size() == chunk.size());
            CHECK(chunk.index() == sizes.size());
            CHECK(chunk.offset() == offset);
            CHECK(&world.get<Position>(chunk.entities().back()) == &positions.back());
            CHECK(chunk.has<Marked>() == (sizes.size() == (count + 1023) / 1024));
            sizes.push_back(chunk.size());
            offset += chunk.size();
        });
        std::vector<std::uint32_t> expected(count / 1024, 1024);
        if (count % 1024 > 0) {
            expected.push_back(count % 1024);
        }
        expected.push_back(7);
        CHECK(sizes == expected);
        CHECK(world.query<Position>().chunk_count() == expected.size());
    }
}

TEST_CASE("query: an optional component that a chunk lacks is an empty span") {
    World world;
    world.create(Position{});
    world.create(Position{}, Velocity{});
    std::size_t with = 0;
    world.query<const Position, Optional<Velocity>>().chunks(
        [&](ChunkView chunk, std::span<const Position>, std::span<Velocity> velocities) {
            CHECK((velocities.empty() || velocities.size() == chunk.size()));
            with += velocities.size();
        });
    CHECK(with == 1);
}

TEST_CASE("query: par_chunks and par_each visit every row once, for any number of threads") {
    const int before = thread_count();
    for (const int threads : {1, 2, 3, 7}) {
        set_thread_count(threads);
        World world;
        fill(world, 10'000);
        world.query<Mass>().par_chunks([](ChunkView, std::span<Mass> masses) {
            for (Mass& mass : masses) {
                mass.value += 0.5;
            }
        });
        world.query<Mass, Optional<const Heat>>().par_each(
            [](Mass& mass, const Heat*) { mass.value += 0.25; });
        world.query<Mass, Heat>().par_each([](Mass& mass, Heat& heat) {
            CHECK_MESSAGE(
                heat.degrees == static_cast<int>(mass.value), "each pairs one entity's components");
            heat.degrees = 1;
        });
        double sum = 0;
        world.query<const Mass>().each([&](const Mass& mass) { sum += mass.value; });
        CHECK(sum == 10'000.0 * 9'999 / 2 + 7'500);
        int heat_sum = 0;
        world.query<const Heat>().each([&](const Heat& heat) { heat_sum += heat.degrees; });
        CHECK(heat_sum == 3334);
    }
    set_thread_count(before);
}

TEST_CASE("query: sums per chunk do not depend on the number of threads") {
    const int before = thread_count();
    World world;
    fill(world, 20'000);
    const auto total = [&] {
        const auto query = world.query<const Mass>();
        std::vector<double> partial(query.chunk_count());
        query.par_chunks([&](ChunkView chunk, std::span<const Mass> masses) {
            for (const Mass& mass : masses) {
                partial[chunk.index()] += 1.0 / (1.0 + mass.value);
            }
        });
        return std::accumulate(partial.begin(), partial.end(), 0.0);
    };
    set_thread_count(1);
    const double expected = total();
    for (const int threads : {2, 3, 16}) {
        set_thread_count(threads);
        CHECK(total() == expected);
    }
    set_thread_count(before);
}

TEST_CASE("query: single gives the only entity and stops when there is none or more") {
    World world;
    CHECK(
        stop_message([&] {
            static_cast<void>(world.query<const Mass>().single());
        }).find("exactly one")
        != std::string::npos);
    const Entity entity = world.create(Mass{3}, Position{});
    const auto [mass, position] = world.query<Mass, const Position>().single();
    mass.value += 1;
    CHECK(world.get<Mass>(entity).value == 4);
    CHECK(position.x == 0);
    CHECK(world.query<const Mass>().single_entity() == entity);
    world.create(Mass{});
    CHECK_FALSE(stop_message([&] {
                    static_cast<void>(world.query<const Mass>().single_entity());
                }).empty());
}

TEST_CASE("query: find gets other entities of the query and no others") {
    World world;
    const Entity inside = world.create(Mass{3}, Heat{2});
    const Entity outside = world.create(Position{});
    const auto query = world.query<Mass, Optional<const Heat>>();
    CHECK(query.find<Mass>(inside)->value == 3);
    CHECK(query.find<const Heat>(inside)->degrees == 2);
    CHECK(query.find<Mass>(outside) == nullptr);
    CHECK(query.find<Mass>(Entity{}) == nullptr);
    world.destroy(inside);
    CHECK(query.find<Mass>(inside) == nullptr);
}

TEST_CASE("query: a structural change while iterating stops with a message") {
    World world;
    const Entity entity = world.create(Position{}, Heat{});
    const std::string part = "structural change while iterating";
    const auto says_so = [&](const auto& change) {
        const std::string inside = stop_message(
            [&] { world.query<const Position>().each([&](const Position&) { change(); }); });
        const std::string in_chunks = stop_message([&] {
            world.query<const Position>().chunks(
                [&](ChunkView, std::span<const Position>) { change(); });
        });
        const std::string in_const = stop_message([&] {
            const World& constant = world;
            constant.query<const Heat>().each([&](const Heat&) { change(); });
        });
        return inside.find(part) != std::string::npos && in_chunks.find(part) != std::string::npos
               && in_const.find(part) != std::string::npos;
    };
    CHECK(says_so([&] { world.create(Mass{}); }));
    CHECK(says_so([&] { world.create_many(3, Mass{}); }));
    CHECK(says_so([&] { world.destroy(entity); }));
    CHECK(says_so([&] { world.add(entity, Mass{}); }));
    CHECK(says_so([&] { world.add(entity, Note{}); }));
    CHECK(says_so([&] { world.remove<Heat>(entity); }));
    CHECK(says_so([&] { world.remove<Position>(entity); }));
    CHECK(says_so([&] { world.clear(); }));
    world.query<const Position>().each(
        [&](const Position&) { world.get<Heat>(entity).degrees = 1; });
    world.create(Mass{});  // allowed again
}

TEST_CASE("query: queries may be nested") {
    World world;
    world.create_many(10, Position{});
    int pairs = 0;
    world.query<const Position>().each([&](const Position&) {
        world.query<const Position>().each([&](const Position&) { ++pairs; });
    });
    CHECK(pairs == 100);
    world.create(Position{});
}

TEST_CASE("query: a const world answers queries of several threads at the same time") {
    World world;
    fill(world, 5000);
    const World& constant = world;
    std::atomic<std::size_t> total = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 20; ++k) {
                constant.query<const Mass>().each(
                    [&](const Mass&) { total.fetch_add(1, std::memory_order_relaxed); });
                total += constant.query<const Heat, Without<Position>>().count();
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    CHECK(total == 4 * 20 * (5000 + 833));
    world.create(Mass{});
}

TEST_CASE("query: gather visits the entities of a list that are alive and match, in list order") {
    World world;
    std::vector<Entity> list;
    std::vector<std::size_t> expected;
    for (int i = 0; i < 3000; ++i) {
        const Position position{static_cast<float>(i), 0, 0};
        const int kind = i * 7 % 5;
        const Entity entity = kind == 0   ? world.create(Velocity{})
                              : kind == 1 ? world.create(position, Mass{})
                                          : world.create(position);
        list.push_back(entity);
        if (kind == 2) {
            world.destroy(entity);
        }
    }
    std::reverse(list.begin(), list.end());
    list.push_back(list[3]);  // some entities twice
    list.push_back(list[3]);
    list.push_back({});
    list.push_back({123'456'789, 1});
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (world.alive(list[i]) && world.has<Position>(list[i])) {
            expected.push_back(i);
        }
    }
    const auto query = world.query<const Position, Optional<Mass>>();
    for (const std::size_t size :
         {list.size(), std::size_t{0}, std::size_t{1}, std::size_t{15}, std::size_t{16},
          std::size_t{17}, std::size_t{63}, std::size_t{64}, std::size_t{65}, std::size_t{129}}) {
        std::vector<std::size_t> seen;
        const std::size_t found = query.gather(
            std::span<const Entity>(list).first(size),
            [&](std::size_t i, const Position& position, const Mass* mass) {
                seen.push_back(i);
                CHECK(&position == std::as_const(world).find<Position>(list[i]));
                CHECK(mass == std::as_const(world).find<Mass>(list[i]));
            });
        const auto end = std::lower_bound(expected.begin(), expected.end(), size);
        CHECK(found == seen.size());
        CHECK(seen == std::vector<std::size_t>(expected.begin(), end));
    }
}

TEST_CASE("query: gather marks what it passes for writing as changed, and nothing else") {
    World world;
    const std::vector<Entity> all = world.create_many(5000, Position{}, Velocity{});
    const std::uint32_t before = world.version();
    const Entity list[] = {all[2048], all[10], all[3071]};
    world.query<Position, const Velocity>().gather(
        list, [](std::size_t i, Position& position, const Velocity&) {
            position.x = static_cast<float>(i + 1);
        });
    CHECK(world.get<const Position>(all[10]).x == 2);
    CHECK(world.get<const Position>(all[3071]).x == 3);
    CHECK(world.query<const Position, Changed<Position>>().since(before).count() == 2 * 1024);
    CHECK(world.query<const Velocity, Changed<Velocity>>().since(before).count() == 0);
}

TEST_CASE("query: gather checks sparse components of each entity") {
    World world;
    std::vector<Entity> list;
    for (int i = 0; i < 100; ++i) {
        list.push_back(world.create(Position{static_cast<float>(i), 0, 0}));
        if (i % 3 == 0) {
            world.add(list.back(), Heat{i});
        }
        if (i % 2 == 0) {
            world.add(list.back(), Selected{});
        }
    }
    int sum = 0;
    CHECK(
        world.query<Heat, const Position, Without<Selected>>().gather(
            list,
            [&](std::size_t i, Heat& heat, const Position& position) {
                CHECK(heat.degrees == static_cast<int>(i));
                CHECK(position.x == static_cast<float>(i));
                heat.degrees = -1;
                ++sum;
            })
        == 17);
    CHECK(sum == 17);
    CHECK(world.get<const Heat>(list[3]).degrees == -1);
    CHECK(world.get<const Heat>(list[6]).degrees == 6);
    int with_heat = 0;
    world.query<const Position, Optional<const Heat>>().gather(
        list, [&](std::size_t, const Position&, const Heat* heat) { with_heat += heat ? 1 : 0; });
    CHECK(with_heat == 34);
}

TEST_CASE("query: gather iterates, so the structure is locked meanwhile") {
    World world;
    const Entity entity = world.create(Position{});
    const std::string message = stop_message([&] {
        world.query<const Position>().gather(
            {&entity, 1}, [&](std::size_t, const Position&) { world.destroy(entity); });
    });
    CHECK(message.find("while iterating") != std::string::npos);
}
