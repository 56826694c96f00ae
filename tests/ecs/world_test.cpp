#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>
#include <vector>

using namespace limn;
using namespace limn::test;

TEST_CASE(
    "world: an entity has the components it was created with and no others"
    * technique("engine.render-object")) {
    World world;
    const Entity entity = world.create(Position{1, 2, 3}, Label{"one", {1}}, Marked{}, Heat{5});
    CHECK(world.alive(entity));
    CHECK(world.entity_count() == 1);
    CHECK(world.get<Position>(entity).y == 2);
    CHECK(world.get<Label>(entity).text == "one");
    CHECK(world.get<Heat>(entity).degrees == 5);
    CHECK(world.has<Marked>(entity));
    CHECK_FALSE(world.has<Velocity>(entity));
    CHECK_FALSE(world.has<Note>(entity));
    CHECK(world.find<Velocity>(entity) == nullptr);
    const World& constant = world;
    CHECK(constant.get<Position>(entity).z == 3);
    CHECK(constant.find<Note>(entity) == nullptr);
}

TEST_CASE("world: an entity may have no components") {
    World world;
    const Entity entity = world.create();
    CHECK(world.alive(entity));
    CHECK(world.components_of(entity).empty());
    world.destroy(entity);
    CHECK_FALSE(world.alive(entity));
}

TEST_CASE(
    "world: a destroyed entity's handle is stale for good, also when its slot is used again"
    * technique("engine.render-object")) {
    World world;
    const Entity first = world.create(Position{});
    world.destroy(first);
    CHECK_FALSE(world.alive(first));
    CHECK(world.find<Position>(first) == nullptr);
    bool reused = false;
    for (std::uint32_t i = 0; i < 3 * EntityTable::kReuseDistance; ++i) {
        const Entity next = world.create(Position{});
        reused = reused || next.index == first.index;
        CHECK(next != first);
        REQUIRE_FALSE(world.alive(first));
        world.destroy(next);
    }
    CHECK(reused);
    CHECK_FALSE(world.alive(Entity{}));
    CHECK_FALSE(world.alive(Entity{12345, 1}));
}

TEST_CASE("world: slots are reused in the order in which they were freed, after a distance") {
    World world;
    std::vector<Entity> entities = world.create_many(5000, Position{});
    for (const Entity entity : entities) {
        world.destroy(entity);
    }
    for (std::uint32_t i = 0; i < 5000 - EntityTable::kReuseDistance; ++i) {
        const Entity entity = world.create(Position{});
        REQUIRE(entity.index == entities[i].index);
        REQUIRE(entity.generation == entities[i].generation + 1);
    }
    CHECK(world.create(Position{}).index == 5000);
}

TEST_CASE("world: a slot whose generations are used up is retired, not reused") {
    EntityTable table;
    EntityTableImage image;
    image.generations = {kPlaceholderBit - 1};
    table.restore(image);
    const Entity last{0, kPlaceholderBit - 1};
    table.set_location(last, 0, 0);
    table.free(last);
    CHECK(table.free_count() == 0);
    CHECK_FALSE(table.find(last));
    CHECK(table.allocate().index == 1);
}

TEST_CASE(
    "world: a slot holds every archetype and row up to the limits, independent of its neighbors") {
    constexpr std::uint32_t kArchetypes[] = {0,    1,      63,       64,
                                             1000, 65'535, 1u << 21, kMaxArchetypes - 1};
    constexpr std::uint32_t kRows[] = {0, 1, 1023, 65'536, kMaxRowsOfSlot - 1};
    EntityTable table;
    const Entity before = table.allocate();
    const Entity entity = table.allocate();
    const Entity after = table.allocate();
    table.set_location(before, 3, 4);
    CHECK_FALSE(table.find(entity));
    for (const std::uint32_t archetype : kArchetypes) {
        for (const std::uint32_t row : kRows) {
            table.set_location(entity, archetype, row);
            REQUIRE(table.find(entity));
            CHECK(table.find(entity).archetype == archetype);
            CHECK(table.find(entity).row == row);
            CHECK_FALSE(table.find(after));
        }
    }
    table.set_location(after, 5, 6);
    CHECK(table.find(before).archetype == 3);
    CHECK(table.find(before).row == 4);
    CHECK(table.find(entity).archetype == kMaxArchetypes - 1);
    CHECK(table.find(after).row == 6);
    CHECK_FALSE(table.find({entity.index, entity.generation + 1}));
    table.free(entity);
    CHECK_FALSE(table.find(entity));
    CHECK_FALSE(table.find({entity.index, entity.generation + 1}));
}

TEST_CASE("world: misuse stops with a message that names the mistake") {
    World world;
    const Entity gone = world.create(Position{});
    world.destroy(gone);
    const Entity entity = world.create(Velocity{});
    using Message = std::string;
    const auto contains = [](const Message& text, const char* part) {
        return text.find(part) != Message::npos;
    };
    CHECK(contains(stop_message([&] { world.destroy(gone); }), "stale handle"));
    CHECK(contains(stop_message([&] { world.add(gone, Velocity{}); }), "stale handle"));
    CHECK(contains(stop_message([&] { world.remove<Position>(gone); }), "stale handle"));
    CHECK(contains(
        stop_message([&] { static_cast<void>(world.components_of(gone)); }), "stale handle"));
    CHECK(contains(stop_message([&] { (void)world.get<Position>(entity); }), "position"));
    CHECK(contains(stop_message([&] { (void)world.resource<Mass>(); }), "mass"));
    CHECK(stop_message([&] { (void)world.get<Velocity>(entity); }).empty());
}

TEST_CASE("world: adding and removing keeps all other components") {
    World world;
    const Entity a = world.create(Position{1, 0, 0}, Label{"a", {}});
    const Entity b = world.create(Position{2, 0, 0}, Label{"b", {}});
    world.add(a, Velocity{7, 0, 0});
    CHECK(world.get<Velocity>(a).x == 7);
    CHECK(world.get<Position>(a).x == 1);
    CHECK(world.get<Label>(a).text == "a");
    CHECK(world.get<Label>(b).text == "b");
    world.add<Marked>(a);
    CHECK(world.remove<Position>(a));
    CHECK_FALSE(world.remove<Position>(a));
    CHECK(world.get<Velocity>(a).x == 7);
    CHECK(world.get<Label>(a).text == "a");
    CHECK(world.remove<Label>(a));
    CHECK(world.has<Marked>(a));
    world.add(b, Label{"replaced", {1, 2}});
    CHECK(world.get<Label>(b).text == "replaced");
    const Mass* mass = &world.add(b, Mass{3});
    CHECK(mass == &world.get<Mass>(b));
}

TEST_CASE("world: sparse components do not move the entity") {
    World world;
    const Entity entity = world.create(Position{});
    const std::size_t archetypes = world.archetypes().size();
    world.add(entity, Note{"hello"});
    world.add(entity, Heat{3});
    world.add<Selected>(entity);
    CHECK(world.archetypes().size() == archetypes);
    CHECK(world.get<Note>(entity).text == "hello");
    CHECK(world.has<Selected>(entity));
    CHECK(world.components_of(entity).size() == 4);
    world.add(entity, Note{"again"});
    CHECK(world.get<Note>(entity).text == "again");
    CHECK(world.remove<Note>(entity));
    CHECK_FALSE(world.remove<Note>(entity));
    CHECK(world.get<Heat>(entity).degrees == 3);
    world.destroy(entity);
    CHECK(world.find<Heat>(entity) == nullptr);
    const Entity next = world.create(Heat{9});
    CHECK(world.get<Heat>(next).degrees == 9);
}

TEST_CASE("world: components that cannot be copied move with their entity") {
    World world;
    const Entity entity = world.create(Owner{std::make_unique<int>(5)});
    for (int i = 0; i < 2000; ++i) {
        world.create(Owner{std::make_unique<int>(i)});
    }
    world.add(entity, Position{});
    CHECK(*world.get<Owner>(entity).value == 5);
}

TEST_CASE("world: every instance that is made is destroyed, once") {
    Counted::living = 0;
    {
        World world;
        std::vector<Entity> entities;
        for (int i = 0; i < 2500; ++i) {
            entities.push_back(world.create(Counted(i), Position{}, SparseCounted{}));
        }
        CHECK(Counted::living == 5000);
        for (std::size_t i = 0; i < entities.size(); i += 2) {
            world.destroy(entities[i]);
        }
        CHECK(Counted::living == 2500);
        for (std::size_t i = 1; i < entities.size(); i += 4) {
            world.remove<Counted>(entities[i]);
            world.add(entities[i], Velocity{});
            world.add(entities[i], SparseCounted{});
        }
        CHECK(Counted::living == 625 + 1250);
        for (std::size_t i = 3; i < entities.size(); i += 4) {
            REQUIRE(world.get<Counted>(entities[i]).value == static_cast<int>(i));
        }
        world.clear();
        CHECK(Counted::living == 0);
        world.create_many(10, Counted(1));
        world.insert_resource(Counted(2));
        world.insert_resource(Counted(3));
        CHECK(Counted::living == 11);
    }
    CHECK(Counted::living == 0);
}

TEST_CASE(
    "world: around multiples of 1024 rows, destroying any row leaves the others as they were") {
    for (const std::uint32_t count : {1023u, 1024u, 1025u, 2047u, 2048u, 2049u}) {
        for (const std::uint32_t victim : {0u, 1022u, 1023u, count / 2, count - 1}) {
            if (victim >= count) {
                continue;
            }
            World world;
            std::vector<Entity> entities;
            for (std::uint32_t i = 0; i < count; ++i) {
                entities.push_back(world.create(
                    Position{static_cast<float>(i), 0, 0}, Label{std::to_string(i), {}}));
            }
            world.destroy(entities[victim]);
            bool same = world.entity_count() == count - 1;
            for (std::uint32_t i = 0; i < count; ++i) {
                same = same
                       && (i == victim
                               ? !world.alive(entities[i])
                               : world.get<Position>(entities[i]).x == static_cast<float>(i)
                                     && world.get<Label>(entities[i]).text == std::to_string(i));
            }
            CHECK(same);
        }
    }
}

TEST_CASE("world: create_many creates adjacent rows with equal values") {
    World world;
    const std::vector<Entity> entities =
        world.create_many(1500, Mass{4}, Label{"many", {}}, Heat{2}, Marked{});
    CHECK(std::set<Entity>(entities.begin(), entities.end()).size() == 1500);
    const auto rows = world.core().archetypes.back()->entities();
    CHECK(std::equal(rows.begin(), rows.end(), entities.begin(), entities.end()));
    for (const Entity entity : entities) {
        REQUIRE(world.get<Mass>(entity).value == 4);
        REQUIRE(world.get<Label>(entity).text == "many");
        REQUIRE(world.get<Heat>(entity).degrees == 2);
        REQUIRE(world.has<Marked>(entity));
    }
    CHECK(world.create_many(0, Mass{}).empty());
}

TEST_CASE("world: a created or added value may be a copy of an existing one, although rows move") {
    // Small archetypes share blocks of memory and move to larger ones as they grow: each round, the
    // value that is copied lies in the column that grows.
    World world;
    const std::string text(100, 'x');
    const Entity first = world.create(Label{text, {1, 2, 3}});
    const auto& info = component_info<Label>();
    const auto is_whole = [&](Entity entity) {
        const Label& label = std::as_const(world).get<Label>(entity);
        return label.text == text && label.numbers == std::vector<int>{1, 2, 3};
    };
    for (int i = 0; i < 300; ++i) {
        const Entity copied = world.create(std::as_const(world).get<Label>(first));
        REQUIRE(is_whole(copied));
        for (const Entity entity : world.create_many(2, std::as_const(world).get<Label>(first))) {
            REQUIRE(is_whole(entity));
        }
        const Entity added = world.create();
        world.add_copy(added, info.id, world.find<Label>(first));
        REQUIRE(is_whole(added));
        const Entity moved = world.create();
        world.add_move(moved, info.id, world.find<Label>(added));
        REQUIRE(is_whole(moved));
        REQUIRE(is_whole(first));
    }
    world.add_copy(first, info.id, world.find<Label>(first));
    world.add_move(first, info.id, world.find<Label>(first));
    CHECK(world.write(first, info.id, world.find<Label>(first)));
    CHECK(is_whole(first));
}

TEST_CASE("world: resources are one of a kind and stay where they are") {
    World world;
    CHECK(world.find_resource<Mass>() == nullptr);
    Mass& mass = world.insert_resource(Mass{1});
    world.insert_resource(Label{"x", {}});
    CHECK(&world.insert_resource(Mass{2}) == &mass);
    CHECK(mass.value == 2);
    CHECK(world.resources().size() == 2);
    CHECK(static_cast<Mass*>(world.find_resource(component_id<Mass>)) == &mass);
    world.remove_resource<Mass>();
    CHECK(world.find_resource<Mass>() == nullptr);
    const World& constant = world;
    CHECK(constant.resource<Label>().text == "x");
    static_cast<void>(world.insert_default_resource(component_id<Mass>));
    CHECK(world.resource<Mass>().value == 1);
}

TEST_CASE("world: everything works type-erased") {
    World world;
    const Entity entity = world.create();
    const ComponentId label = component_id<Label>;
    static_cast<Label*>(world.add(entity, label))->text = "set";
    CHECK(world.get<Label>(entity).text == "set");
    world.add(entity, component_id<Marked>);
    world.add(entity, component_id<Selected>);
    const Label other{"copy", {1}};
    world.add_copy(entity, label, &other);
    CHECK(world.get<Label>(entity).text == "copy");
    Owner owner{std::make_unique<int>(3)};
    world.add_move(entity, component_id<Owner>, &owner);
    CHECK(*world.get<Owner>(entity).value == 3);
    const Note note{"sparse"};
    world.add_copy(entity, component_id<Note>, &note);
    std::vector<ComponentId> expected = {
        label, component_id<Marked>, component_id<Selected>, component_id<Owner>,
        component_id<Note>};
    std::sort(expected.begin(), expected.end());
    CHECK(world.components_of(entity) == expected);
    CHECK(
        static_cast<const Note*>(std::as_const(world).find(entity, component_id<Note>))->text
        == "sparse");
    CHECK(world.find(entity, component_id<Marked>) != nullptr);
    CHECK(world.find(entity, component_id<Mass>) == nullptr);
    for (const ComponentId id : expected) {
        CHECK(world.remove(entity, id));
        CHECK_FALSE(world.remove(entity, id));
    }
    CHECK(world.components_of(entity).empty());
}

TEST_CASE("world: rounds of creating and destroying do not grow the memory") {
    World world;
    const auto round = [&](std::size_t count) {
        for (const Entity entity : world.create_many(count, Position{}, Heat{})) {
            world.destroy(entity);
        }
    };
    round(3000);
    round(3000);
    const std::size_t before = world.memory().total();
    for (int i = 0; i < 100; ++i) {
        round(3000);
    }
    CHECK(world.memory().total() == before);
    CHECK(world.memory().used == 0);
}

TEST_CASE("world: 40 bytes of components take at most 60 bytes of memory each") {
    struct Payload {
        float values[4];
    };
    constexpr std::size_t kCount = 1'000'000;
    World world;
    world.create_many(kCount, Position{}, Velocity{}, Payload{});
    CHECK(
        static_cast<double>(world.memory().total()) / kCount
        <= 60.0 + 8.0);  // steps of 2 MiB in five ranges
    CHECK(world.memory().used == kCount * 48);
}

TEST_CASE("world: the statistics add up") {
    World world;
    world.create_many(2000, Position{}, Marked{});
    world.create(Label{}, Heat{});
    const WorldStats stats = world_stats(world);
    CHECK(stats.entities == 2001);
    CHECK(stats.archetypes.size() == 3);
    CHECK(stats.archetypes[1].rows == 2000);
    CHECK(stats.archetypes[1].chunks == 2);
    CHECK(stats.archetypes[1].row_bytes == 20);
    CHECK(stats.archetypes[1].components.size() == 2);
    CHECK(stats.archetypes[1].promoted);
    CHECK(stats.sparse_sets.size() == 1);
    CHECK(stats.sparse_sets[0].values == 1);
    CHECK(to_text(stats).find("2001 entities") == 0);
}

TEST_CASE("world: a restored world has the same handles, rows and next handles") {
    World source;
    std::vector<Entity> entities;
    for (int i = 0; i < 3000; ++i) {
        entities.push_back(
            i % 3 == 0 ? source.create(Position{static_cast<float>(i), 0, 0})
                       : source.create(Position{static_cast<float>(i), 0, 0}, Velocity{}, Heat{i}));
    }
    for (std::size_t i = 0; i < entities.size(); i += 2) {
        source.destroy(entities[i]);
    }

    World copy;
    copy.create(Velocity{}, Label{"to be forgotten", {}});
    static_cast<void>(copy.query<const Position>().count());  // remembers archetypes that go
    copy.begin_restore(source.entity_image());
    for (const auto& rows : source.archetypes()) {
        Archetype& restored = copy.restore_rows(rows->components(), rows->entities());
        for (std::size_t i = 0; i < rows->columns().size(); ++i) {
            std::memcpy(
                restored.columns()[i].data, rows->columns()[i].data,
                rows->size() * rows->columns()[i].size);
        }
    }
    for (const SparseSet* set : source.sparse_sets()) {
        SparseSet& restored = copy.restore_sparse(set->info().id, set->entities());
        std::memcpy(restored.value(0), set->value(0), set->size() * sizeof(Heat));
    }
    copy.end_restore();

    CHECK(copy.entity_count() == source.entity_count());
    CHECK(copy.query<const Position>().count() == source.query<const Position>().count());
    CHECK(copy.query<const Label>().count() == 0);
    std::vector<Entity> order;
    source.query<const Position>().each(
        [&](Entity entity, const Position&) { order.push_back(entity); });
    std::size_t next = 0;
    copy.query<const Position>().each([&](Entity entity, const Position& position) {
        REQUIRE(entity == order[next++]);
        REQUIRE(position.x == source.get<Position>(entity).x);
        REQUIRE(copy.has<Heat>(entity) == source.has<Heat>(entity));
    });
    for (int i = 0; i < 2000; ++i) {
        REQUIRE(copy.create(Position{}) == source.create(Position{}));
    }
}

TEST_CASE("world: shrink releases unused memory, and all values stay") {
    World world;
    const std::vector<Entity> many = world.create_many(100'000, Position{1, 2, 3}, Mass{}, Heat{4});
    std::vector<Entity> few;
    for (int i = 0; i < 500; ++i) {
        few.push_back(world.create(Velocity{static_cast<float>(i), 0, 0}));
    }
    const std::size_t before = world.memory().total();
    for (std::size_t i = 2000; i < many.size(); ++i) {
        world.destroy(many[i]);
    }
    for (std::size_t i = 10; i < few.size(); ++i) {
        world.destroy(few[i]);
    }
    CHECK(world.memory().total() + 1000 > before);
    world.shrink();
    CHECK(world.memory().archetypes < 2000 * (sizeof(Entity) + 12 + 8) + 3 * 4096 + kSkewRange);
    for (std::size_t i = 0; i < 2000; ++i) {
        REQUIRE(world.get<const Position>(many[i]).z == 3);
        REQUIRE(world.get<const Heat>(many[i]).degrees == 4);
    }
    for (std::size_t i = 0; i < 10; ++i) {
        REQUIRE(world.get<const Velocity>(few[i]).x == static_cast<float>(i));
    }
    world.create_many(100'000, Position{5, 6, 7}, Mass{}, Heat{8});
    CHECK(world.query<const Position>().count() == 102'000);
    CHECK(world.get<const Position>(many[1999]).z == 3);

    world.clear();
    world.shrink();
    const WorldMemory empty = world.memory();
    CHECK(empty.archetypes + empty.blocks + empty.sparse == 0);
    const Entity again = world.create(Position{1, 1, 1}, Heat{2});
    CHECK(world.get<const Position>(again).x == 1);
    CHECK(world.get<const Heat>(again).degrees == 2);
    const std::string message = stop_message(
        [&] { world.query<const Position>().each([&](const Position&) { world.shrink(); }); });
    CHECK(message.find("while iterating") != std::string::npos);
}

TEST_CASE("world: a million rounds of create, change and destroy take no more memory than a few") {
    World world;
    std::vector<Entity> living;
    std::size_t warm = 0;
    std::size_t next = 0;
    for (int round = 0; round < 1'000'000; ++round) {
        const Entity entity = world.create(Position{}, Mass{});
        if (round % 2 == 0) {
            world.add(entity, Velocity{});
        }
        if (round % 3 == 0) {
            world.add(entity, Heat{});
        }
        if (living.size() < 3000) {
            living.push_back(entity);
            continue;
        }
        if (round % 5 == 0) {
            world.remove<Mass>(living[next]);
        }
        world.destroy(living[next]);
        living[next] = entity;
        next = (next + 1) % living.size();
        if (round == 50'000) {
            warm = world.memory().total();
        }
    }
    CHECK(world.memory().total() == warm);
    CHECK(world.entity_count() == 3000);
}
