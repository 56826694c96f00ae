#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/prefab.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/toggle_components.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace toggle_test;
using limn::test::stop_message;

TEST_CASE("toggle: a disabled component is there, with its value, but queries do not find it") {
    World world;
    const Entity entity = world.create(Power{5}, Lit{});
    CHECK(world.is_enabled<Power>(entity));
    CHECK(world.disable<Power>(entity));
    CHECK_FALSE(world.disable<Power>(entity));
    CHECK_FALSE(world.is_enabled<Power>(entity));
    CHECK(world.has<Power>(entity));
    CHECK(world.get<Power>(entity).value == 5);
    CHECK(world.query<const Power>().empty());
    CHECK(world.query<const Power>().find<const Power>(entity) == nullptr);
    CHECK(world.query<Without<Power>>().single_entity() == entity);
    CHECK(world.is_enabled<Lit>(entity));
    CHECK(world.enable<Power>(entity));
    CHECK_FALSE(world.enable<Power>(entity));
    CHECK(world.query<const Power>().find<const Power>(entity)->value == 5);
    CHECK(std::get<0>(world.query<const Power, With<Lit>>().single()).value == 5);
    CHECK_FALSE(world.is_enabled<Motto>(entity));
    world.destroy(entity);
    CHECK_FALSE(world.is_enabled<Power>(entity));
}

TEST_CASE("toggle: adding enables, replacing the value through a reference or set does not") {
    World world;
    const Entity entity = world.create(Power{1});
    const auto disabled = [&] {
        world.disable<Power>(entity);
        return !world.is_enabled<Power>(entity);
    };
    REQUIRE(disabled());
    world.get<Power>(entity).value = 2;
    CHECK_FALSE(world.is_enabled<Power>(entity));
    world.add(entity, Power{3});
    CHECK(world.is_enabled<Power>(entity));
    REQUIRE(disabled());
    world.add(entity, component_id<Power>);
    CHECK(world.is_enabled<Power>(entity));
    CHECK(world.get<Power>(entity).value == 3);
    REQUIRE(disabled());
    const Power four{4};
    world.add_copy(entity, component_id<Power>, &four);
    CHECK(world.is_enabled<Power>(entity));
    REQUIRE(disabled());
    world.run([entity](Commands commands) { commands.set(entity, Power{5}); });
    CHECK_FALSE(world.is_enabled<Power>(entity));
    CHECK(world.get<Power>(entity).value == 5);
    world.run([entity](Commands commands) { commands.add(entity, Power{6}); });
    CHECK(world.is_enabled<Power>(entity));
    REQUIRE(disabled());
    world.remove<Power>(entity);
    world.add(entity, Power{7});
    CHECK(world.is_enabled<Power>(entity));
}

TEST_CASE("toggle: commands fold in order, and do nothing to entities without the component") {
    World world;
    const Entity a = world.create(Body{}, Power{1});
    const Entity b = world.create(Body{});
    const Entity c = world.create(Body{}, Power{3});
    const Entity d = world.create(Body{}, Lit{});
    Entity made;
    world.run([&](Commands commands) {
        commands.disable<Power>(a);
        commands.disable<Power>(b);
        commands.remove<Power>(c);
        commands.disable<Power>(c);
        commands.add(c, Power{4});
        commands.add(d, Power{5});
        commands.disable<Power>(d);
        commands.disable<Lit>(d);
        commands.enable<Lit>(d);
        const Entity placeholder = commands.create(Body{}, Motto{"new"});
        commands.disable<Motto>(placeholder);
    });
    CHECK_FALSE(world.is_enabled<Power>(a));
    CHECK_FALSE(world.has<Power>(b));
    CHECK(world.is_enabled<Power>(c));
    CHECK(world.get<Power>(c).value == 4);
    CHECK(world.has<Power>(d));
    CHECK_FALSE(world.is_enabled<Power>(d));
    CHECK(world.is_enabled<Lit>(d));
    made = world.query<const Body, Without<Motto, Power, Lit>>().contains(b) ? b : Entity{};
    CHECK(made == b);
    CHECK(world.query<const Motto>().empty());
    CHECK(world_stats(world).entities == 5);
}

TEST_CASE("toggle: rows keep their bits when others are removed, and new rows are enabled") {
    for (const std::size_t count : {1023u, 1024u, 1025u, 2047u, 2048u, 2049u}) {
        World world;
        std::vector<Entity> entities = world.create_many(count, Power{});
        for (std::size_t i = 0; i < count; i += 3) {
            world.disable<Power>(entities[i]);
        }
        for (std::size_t i = 0; i < count; i += 7) {
            world.destroy(entities[i]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            CHECK(world.is_enabled<Power>(entities[i]) == (i % 7 != 0 && i % 3 != 0));
        }
        for (const Entity entity : world.create_many(count, Power{})) {
            CHECK(world.is_enabled<Power>(entity));
        }
        world.clear();
        world.create_many(count, Power{});
        CHECK(world.query<const Power>().count() == count);
    }
}

TEST_CASE("toggle: chunks() skips fully disabled chunks, and each() does not touch them") {
    World world;
    const std::vector<Entity> entities = world.create_many(3000, Power{});
    for (std::size_t i = 1024; i < 2048; ++i) {
        world.disable<Power>(entities[i]);
    }
    world.disable<Power>(entities[5]);
    const std::uint32_t before = world.version();
    std::vector<std::uint32_t> indices;
    world.query<const Power>().chunks([&](ChunkView chunk, std::span<const Power> powers) {
        CHECK(powers.size() == chunk.size());
        CHECK(chunk.all_enabled() == (chunk.index() == 2));
        CHECK(chunk.enabled<Power>() == chunk.enabled());
        indices.push_back(chunk.index());
    });
    CHECK(indices == std::vector<std::uint32_t>{0, 2});
    world.query<Power>().each([](Power& power) { power.value = 1; });
    CHECK(world.get<const Power>(entities[5]).value == 0);
    CHECK(world.query<Without<Body>, Changed<Power>>().since(before).count() == 1023 + 952);
    world.enable<Power>(entities[1030]);
    CHECK(world.query<Changed<Power>>().since(before).count() == 1023 + 952 + 1);
}

TEST_CASE("toggle: the chunk of a written term enables and disables while iterating") {
    World world;
    const std::vector<Entity> entities = world.create_many(2500, Power{}, Lit{});
    const auto by_value = [](Query<Power, Optional<Lit>> query) {
        query.par_chunks([](ChunkView chunk, std::span<Power> powers, std::span<Lit> lit) {
            CHECK(lit.empty());
            for (std::uint32_t row = 0; row < chunk.size(); ++row) {
                powers[row].value = static_cast<int>(chunk.entities()[row].index % 3);
                chunk.set_enabled<Power>(row, powers[row].value != 0);
                chunk.set_enabled<Lit>(row, powers[row].value == 1);
            }
            CHECK(chunk.all_enabled());
        });
    };
    world.run(by_value);
    for (const Entity entity : entities) {
        CHECK(world.is_enabled<Power>(entity) == (entity.index % 3 != 0));
        CHECK(world.is_enabled<Lit>(entity) == (entity.index % 3 == 1));
    }
}

TEST_CASE("toggle: misuse stops with a message") {
    World world;
    const Entity with = world.create(Power{});
    const Entity without = world.create(Body{});
    CHECK(stop_message([&] { world.disable<Power>(without); }).find("power") != std::string::npos);
    const std::string iterating = stop_message(
        [&] { world.query<const Body>().each([&](const Body&) { world.disable<Power>(with); }); });
    CHECK(iterating.find("while iterating") != std::string::npos);
    const std::string unwritten = stop_message([&] {
        world.query<const Power>().chunks(
            [](ChunkView chunk, std::span<const Power>) { chunk.set_enabled<Power>(0, false); });
    });
    CHECK(unwritten.find("not a written term") != std::string::npos);
    world.destroy(with);
    CHECK(stop_message([&] { world.disable<Power>(with); }).find("stale") != std::string::npos);
}

// ---- versions
// ------------------------------------------------------------------------------------

namespace toggle_test {

struct Watched {
    std::size_t powers = 0;
    std::size_t lights = 0;
};

void watch(
    Query<With<Body>, Changed<Power>> powers, Query<With<Body>, Changed<Lit>> lights,
    Res<Watched> watched) {
    *watched = {powers.count(), lights.count()};
}

}  // namespace toggle_test

TEST_CASE(
    "toggle: enabling and disabling is a change of the component in its chunk, if it is one") {
    for (const std::uint32_t start : {1u, 0x7ffffff0u, 0xfffffff0u}) {
        World world;
        world.set_version(start);
        world.insert_resource(Watched{});
        const std::vector<Entity> entities = world.create_many(3000, Body{}, Power{}, Lit{});
        const auto seen = [&] {
            world.run(watch);
            const Watched& watched = world.resource<Watched>();
            return std::pair(watched.powers, watched.lights);
        };
        using Pair = std::pair<std::size_t, std::size_t>;
        CHECK(seen() == Pair{3000, 3000});
        for (int i = 0; i < 10; ++i) {
            CHECK(seen() == Pair{0, 0});
            world.disable<Power>(entities[1500]);
            CHECK(seen() == Pair{1023, 0});
            world.disable<Power>(entities[1500]);
            CHECK(seen() == Pair{0, 0});
            world.disable<Lit>(entities[5]);
            CHECK(seen() == Pair{0, 1023});
            world.run([&](Commands commands) {
                commands.enable<Lit>(entities[5]);
                commands.enable<Power>(entities[1500]);
            });
            CHECK(seen() == Pair{1024, 1024});
        }
        const std::uint32_t before = world.version();
        world.disable<Lit>(entities[2999]);
        std::vector<bool> changed;
        world.query<const Power>().chunks([&](ChunkView chunk, std::span<const Power>) {
            changed.push_back(chunk.changed_since<Lit>(before));
        });
        CHECK(changed == std::vector<bool>{false, false, true});
    }
}

TEST_CASE("toggle: an old change of a bit never counts as new again") {
    World world;
    world.insert_resource(Watched{});
    const Entity entity = world.create(Body{}, Lit{});
    world.create(Body{}, Lit{});
    world.disable<Lit>(entity);
    world.run(watch);
    std::uint32_t version = world.version();
    for (int i = 0; i < 40; ++i) {
        version += 1u << 27;
        world.set_version(version);
        const std::uint32_t recently = world.version() - 1000;
        world.run(watch);
        CHECK(world.resource<Watched>().lights == 0);
        CHECK(world.query<Changed<Lit>>().since(recently).count() == 0);
    }
    world.enable<Lit>(entity);
    world.run(watch);
    CHECK(world.resource<Watched>().lights == 2);
}

TEST_CASE("toggle: enabling and disabling calls no observer") {
    World world;
    int calls = 0;
    world.on_add<Power>([&](World&, std::span<const Entity>) { ++calls; });
    world.on_remove<Power>([&](World&, std::span<const Entity>) { ++calls; });
    const Entity entity = world.create(Power{});
    CHECK(calls == 1);
    world.disable<Power>(entity);
    world.enable<Power>(entity);
    world.run([entity](Commands commands) { commands.disable<Power>(entity); });
    world.add(entity, Power{2});
    CHECK(calls == 1);
    world.disable<Power>(entity);
    world.remove<Power>(entity);
    CHECK(calls == 2);
}

// ---- threads, snapshots, prefabs
// ------------------------------------------------------------------------------------

namespace toggle_test {

void charge(Query<ToggledCharge, With<ToggledSign>> charges) {
    charges.par_each([](ToggledCharge& charge) { charge.value += 3; });
}
void flip(Query<ToggledCharge> charges) {
    charges.par_chunks([](ChunkView chunk, std::span<ToggledCharge> values) {
        chunk.enabled().for_each([&](std::uint32_t row) {
            values[row].value += 1;
            chunk.set_enabled<ToggledCharge>(row, values[row].value % 5 != 0);
        });
    });
}

/// About `count` entities of two archetypes, a third of the bits disabled, some holes filled.
void fill_toggled(World& world, std::size_t count) {
    register_toggled();
    Random random(7, 0, 0, 0);
    std::vector<Entity> entities;
    for (std::size_t i = 0; i < count; ++i) {
        entities.push_back(
            i % 5 == 0 ? world.create(ToggledCharge{static_cast<int>(i)})
                       : world.create(ToggledCharge{static_cast<int>(i)}, ToggledSign{}));
        if (random.below(3) == 0) {
            world.disable<ToggledCharge>(entities.back());
        }
        if (i % 5 != 0 && random.below(3) == 0) {
            world.disable<ToggledSign>(entities.back());
        }
    }
    for (std::size_t i = 0; i < count; i += 11) {
        world.destroy(entities[i]);
    }
}

}  // namespace toggle_test

TEST_CASE("toggle: the same bits for any number of threads") {
    const int threads = thread_count();
    std::vector<std::uint64_t> hashes;
    for (const int count : {1, 2, 7}) {
        set_thread_count(count);
        World world;
        fill_toggled(world, 20'000);
        for (int i = 0; i < 4; ++i) {
            world.run(charge);
            world.run(flip);
        }
        hashes.push_back(state_hash(world));
    }
    set_thread_count(threads);
    CHECK(hashes[1] == hashes[0]);
    CHECK(hashes[2] == hashes[0]);
}

TEST_CASE("toggle: a snapshot restores every bit") {
    for (const std::size_t count : {1u, 63u, 64u, 65u, 1130u, 3000u}) {
        World world;
        fill_toggled(world, count);
        const Result<std::vector<std::byte>> bytes = save_snapshot(world);
        REQUIRE(bytes.ok());
        World copy;
        copy.create(Body{});
        REQUIRE(restore_snapshot(copy, *bytes).ok());
        CHECK(state_hash(copy) == state_hash(world));
        world.each_entity([&](Entity entity) {
            CHECK(
                copy.is_enabled<ToggledCharge>(entity) == world.is_enabled<ToggledCharge>(entity));
            CHECK(copy.is_enabled<ToggledSign>(entity) == world.is_enabled<ToggledSign>(entity));
        });
        CHECK(*save_snapshot(copy) == *bytes);
    }
}

TEST_CASE("toggle: the state hash depends on every bit, and not on changes that were undone") {
    World world;
    const std::vector<Entity> entities = world.create_many(1030, ToggledCharge{}, ToggledSign{});
    const std::uint64_t enabled = state_hash(world);
    std::vector<std::uint64_t> hashes{enabled};
    for (const std::size_t i : {0u, 1u, 63u, 64u, 1023u, 1024u, 1029u}) {
        world.disable<ToggledCharge>(entities[i]);
        hashes.push_back(state_hash(world));
        world.enable<ToggledCharge>(entities[i]);
        world.disable<ToggledSign>(entities[i]);
        hashes.push_back(state_hash(world));
        world.enable<ToggledSign>(entities[i]);
        CHECK(state_hash(world) == enabled);
    }
    std::sort(hashes.begin(), hashes.end());
    CHECK(std::adjacent_find(hashes.begin(), hashes.end()) == hashes.end());
    World longer;
    const std::vector<Entity> more = longer.create_many(5000, ToggledCharge{}, ToggledSign{});
    for (std::size_t i = more.size(); i > 1030; --i) {
        longer.disable<ToggledSign>(more[i - 1]);
        longer.destroy(more[i - 1]);
    }
    longer.disable<ToggledSign>(more[3]);
    world.disable<ToggledSign>(entities[3]);
    CHECK(state_hash(longer) == state_hash(world));
}

TEST_CASE("toggle: copies of a prefab have the same components disabled") {
    register_toggled();
    World world;
    const Entity root = world.create(ToggledCharge{1}, ToggledSign{});
    const Entity child = world.create(ToggledCharge{2}, ToggledSign{}, Parent{root});
    world.disable<ToggledSign>(root);
    world.disable<ToggledCharge>(child);
    const Prefab prefab = make_prefab(world, root);
    for (const Entity copy : spawn(world, prefab, 3)) {
        CHECK(world.is_enabled<ToggledCharge>(copy));
        CHECK(world.has<ToggledSign>(copy));
        CHECK_FALSE(world.is_enabled<ToggledSign>(copy));
    }
    CHECK(world.query<const ToggledCharge>().count() == 4);
    CHECK(world.query<With<ToggledSign>>().count() == 4);
    CHECK(world.query<With<Parent>, Without<ToggledCharge>>().count() == 4);
}

TEST_CASE("toggle: bits move with ranges of rows, whole archetypes and filled holes") {
    for (const std::size_t count : {1023u, 1024u, 1025u, 3000u}) {
        World world;
        const std::vector<Entity> entities = world.create_many(count, Power{}, Lit{}, Body{});
        const auto is_on = [](std::size_t i) { return i % 3 != 0 && (i < 1024 || i >= 2048); };
        for (std::size_t i = 0; i < count; ++i) {
            world.set_enabled<Power>(entities[i], is_on(i));
            world.set_enabled<Lit>(entities[i], !is_on(i));
        }
        std::vector<bool> alive(count, true);
        const auto check = [&] {
            std::size_t wrong = 0;
            std::size_t on = 0;
            for (std::size_t i = 0; i < count; ++i) {
                on += alive[i] && is_on(i) ? 1 : 0;
                wrong += world.is_enabled<Power>(entities[i]) == (alive[i] && is_on(i)) ? 0 : 1;
                wrong += world.is_enabled<Lit>(entities[i]) == (alive[i] && !is_on(i)) ? 0 : 1;
            }
            CHECK(wrong == 0);
            CHECK(world.query<const Power>().count() == on);
        };
        world.add_all(world.query<const Body>(), Motto{"all"});  // hands the columns over
        check();
        world.run([](Query<const Body> rows, Commands commands) {
            rows.each([&](Entity entity, const Body&) { commands.remove<Motto>(entity); });
        });
        check();
        world.run([&](Query<const Body> rows, Commands commands) {
            rows.each([&](Entity entity, const Body&) {
                if (entity.index % 7 < 3) {
                    commands.add(entity, Motto{"some"});
                }
            });
        });
        check();
        for (std::size_t i = 0; i < count; ++i) {
            alive[i] = !(entities[i].index % 7 < 3 && i % 2 == 0);
        }
        world.run([&](Query<const Motto> rows, Commands commands) {
            rows.each([&](Entity entity, const Motto&) {
                const auto found = std::find(entities.begin(), entities.end(), entity);
                if (!alive[static_cast<std::size_t>(found - entities.begin())]) {
                    commands.destroy(entity);
                }
            });
        });
        check();
        world.remove_all<Motto>(world.query<With<Body>>());  // behind the rows that stayed
        check();
        const std::size_t off = world.query<Without<Power>>().count();
        world.destroy_all(world.query<const Power>());
        CHECK(world.entity_count() == off);
        CHECK(world.query<With<Lit>>().count() == off);
        world.destroy_all(world.query<const Body>());
        CHECK(world.entity_count() == 0);
        world.create_many(count, Power{}, Lit{}, Body{});
        CHECK(world.query<const Power, With<Lit>>().count() == count);
    }
}
