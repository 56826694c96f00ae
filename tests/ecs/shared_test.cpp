#include "ecs/component_bytes.h"
#include "ecs/prefab.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

// Shared components: the value is part of the identity of an archetype, so that entities of equal
// value are one batch.

namespace shared_test {

using namespace limn;
using namespace limn::test;

struct Region {
    std::uint32_t id = 0;
    std::uint32_t layer = 0;
    bool operator==(const Region&) const = default;
    auto operator<=>(const Region&) const = default;
};
template <typename Visitor>
void visit_fields(Region& region, Visitor&& visit) {
    visit("id", region.id);
    visit("layer", region.layer);
}

/// Another, with bytes that nobody knows.
struct Season {
    char letter = 's';
};

bool contains(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

}  // namespace shared_test

template <>
struct limn::ComponentTraits<shared_test::Region> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Shared;
};
template <>
struct limn::ComponentTraits<shared_test::Season> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Shared;
};

namespace shared_test {

/// The values of a world beside a map, through the same operations.
class Model {
  public:
    explicit Model(unsigned seed) : random_(seed) {}

    void run(int operations) {
        for (int i = 0; i < operations; ++i) {
            step();
            if (i % 101 == 0) {
                compare();
            }
        }
        compare();
    }

  private:
    unsigned roll(unsigned sides) { return static_cast<unsigned>(random_() % sides); }
    Region region() { return {roll(7), roll(2)}; }
    Entity pick() { return entities_[roll(static_cast<unsigned>(entities_.size()))]; }

    void step() {
        const unsigned kind = entities_.empty() ? 0 : roll(14);
        if (kind <= 1) {
            const Region key = region();
            add(roll(2) == 0 ? world_.create(key, Position{}) : world_.create(Label{"x", {}}, key),
                key);
            return;
        }
        const Entity entity = pick();
        const Region key = region();
        switch (kind) {
        case 2:
            for (const Entity made : world_.create_many(roll(40), key, Season{'w'}, Velocity{})) {
                add(made, key);
            }
            break;
        case 3:
            world_.destroy(entity);
            std::erase(entities_, entity);
            keys_.erase(entity);
            break;
        case 4:
            world_.add(entity, key);
            keys_[entity] = key;
            break;
        case 5:
            CHECK(world_.remove<Region>(entity) == (keys_.erase(entity) == 1));
            break;
        case 6:
            if (world_.has<Region>(entity)) {
                world_.set(entity, key);
                keys_[entity] = key;
            }
            break;
        case 7:
            world_.add(entity, Mass{});
            break;
        case 8:
            world_.remove<Position>(entity);
            break;
        case 9:
            world_.add(entity, component_id<Region>);
            keys_.try_emplace(entity);
            break;
        case 10: {
            Region value = key;
            if (world_.write(entity, component_id<Region>, &value)) {
                keys_[entity] = key;
            }
            break;
        }
        case 11:
            world_.add(entity, Season{static_cast<char>('a' + roll(3))});
            break;
        case 12:
            world_.add_all(world_.query<With<Mass>>().where(Region{2, 1}), key);
            for (auto& [one, present] : keys_) {
                present = present == Region{2, 1} && world_.has<Mass>(one) ? key : present;
            }
            break;
        default:
            record();
        }
    }

    void add(Entity entity, Region key) {
        entities_.push_back(entity);
        keys_[entity] = key;
    }

    void record() {
        CommandBuffer buffer;
        const Commands commands(buffer);
        for (int i = 0; i < 20; ++i) {
            const Entity entity = pick();
            const Region key = region();
            switch (roll(4)) {
            case 0:
                commands.add(entity, key);
                keys_[entity] = key;
                break;
            case 1:
                commands.set(entity, key);
                if (keys_.contains(entity)) {
                    keys_[entity] = key;
                }
                break;
            case 2:
                commands.remove<Region>(entity);
                keys_.erase(entity);
                break;
            default:
                commands.add_default(entity, component_id<Region>);
                keys_[entity] = Region{};
            }
        }
        CommandBuffer* const buffers[] = {&buffer};
        apply_commands(world_, buffers);
    }

    void compare() {
        const World& world = world_;
        REQUIRE(world.entity_count() == entities_.size());
        std::map<Region, std::set<Entity>> by_key;
        for (const Entity entity : entities_) {
            const auto found = keys_.find(entity);
            REQUIRE(world.has<Region>(entity) == (found != keys_.end()));
            if (found != keys_.end()) {
                CHECK(world.get<Region>(entity) == found->second);
                CHECK(world.value<Region>(entity) == found->second);
                by_key[found->second].insert(entity);
            }
        }
        // Each value once, one batch after the other.
        std::map<Region, std::set<Entity>> visited;
        std::vector<Region> batches;
        world.query<const Region>().each([&](Entity entity, const Region& key) {
            if (batches.empty() || batches.back() != key) {
                batches.push_back(key);
            }
            visited[key].insert(entity);
        });
        CHECK(visited == by_key);
        CHECK(batches.size() == by_key.size());
        for (std::uint32_t id = 0; id < 8; ++id) {
            const Region key{id, id % 2};
            std::set<Entity> chosen;
            world.query<With<Region>>().where(key).each(
                [&](Entity entity) { chosen.insert(entity); });
            const auto expected = by_key.find(key);
            CHECK(chosen == (expected == by_key.end() ? std::set<Entity>() : expected->second));
        }
    }

    std::mt19937 random_;
    World world_;
    std::vector<Entity> entities_;
    std::map<Entity, Region> keys_;
};

TEST_CASE("shared: entities of equal value are one batch, whatever their history") {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        Model(seed).run(600);
    }
}

TEST_CASE("shared: where() finds the same entities as a full scan, for each kind of call") {
    World world;
    std::mt19937 random(5);
    for (int i = 0; i < 9000; ++i) {
        const Region key{static_cast<std::uint32_t>(random() % 3), 0};
        const Season season{random() % 2 == 0 ? 'a' : 'b'};
        const Position position{static_cast<float>(i), 0, 0};
        const Entity entity =
            random() % 2 == 0 ? world.create(position, key, season) : world.create(key, position);
        if (random() % 4 == 0) {
            world.add(entity, Heat{i});
        }
    }
    const Region wanted{1, 0};
    std::vector<Entity> by_hand;
    world.query<const Region>().each([&](Entity entity, const Region& key) {
        if (key == wanted) {
            by_hand.push_back(entity);
        }
    });
    const auto query = world.query<const Position, const Region>().where(wanted);
    CHECK(query.count() == by_hand.size());
    std::vector<Entity> found;
    query.each([&](Entity entity, const Position&, const Region& key) {
        CHECK(key == wanted);
        found.push_back(entity);
    });
    CHECK(found == by_hand);
    found.clear();
    std::uint32_t chunk_count = 0;
    query.chunks([&](ChunkView chunk, std::span<const Position>, const Region& key) {
        CHECK(key == wanted);
        CHECK(chunk.index() == chunk_count++);
        CHECK(chunk.offset() == found.size());
        found.insert(found.end(), chunk.entities().begin(), chunk.entities().end());
    });
    CHECK(found == by_hand);
    CHECK(query.chunk_count() == chunk_count);
    for (const Entity entity : by_hand) {
        CHECK(query.contains(entity));
    }
    std::size_t outside = 0;
    world.query<const Region>().each([&](Entity entity, const Region& key) {
        outside += key != wanted && !query.contains(entity) ? 1 : 0;
    });
    CHECK(outside + by_hand.size() == world.entity_count());

    world.query<Position>().where(wanted).par_each([](Position& p) { p.y = 1; });
    std::size_t marked = 0;
    world.query<const Position>().each([&](const Position& p) { marked += p.y > 0 ? 1 : 0; });
    CHECK(marked == by_hand.size());

    // Two values at once, a sparse term, and a value that nothing has.
    std::size_t both = 0;
    std::size_t hot = 0;
    for (const Entity entity : by_hand) {
        both += world.has<Season>(entity) && world.value<Season>(entity).letter == 'b' ? 1 : 0;
        hot += world.has<Heat>(entity) ? 1 : 0;
    }
    CHECK(world.query<With<Position>>().where(wanted).where(Season{'b'}).count() == both);
    CHECK(world.query<const Heat>().where(wanted).count() == hot);
    CHECK(world.query<With<Position>>().where(Region{99, 0}).empty());
    CHECK(world.query<With<Position>>().where(wanted).where(Season{'z'}).empty());
}

TEST_CASE("shared: another value moves the entity once, the same value not at all") {
    World world;
    const Entity entity = world.create(Position{1, 2, 3}, Region{1, 0});
    const auto moves = [&] {
        std::uint64_t total = 0;
        for (const auto& archetype : world.archetypes()) {
            total += archetype->rows_moved_in;
        }
        return total;
    };
    const std::uint64_t before = moves();
    world.set(entity, Region{1, 0});
    world.add(entity, Region{1, 0});
    CHECK(moves() == before);
    world.set(entity, Region{2, 0});
    CHECK(moves() == before + 1);
    CommandBuffer buffer;
    const Commands commands(buffer);
    commands.set(entity, Region{3, 0});
    commands.add(entity, Velocity{});
    commands.set(entity, Region{4, 0});
    CommandBuffer* const buffers[] = {&buffer};
    apply_commands(world, buffers);
    CHECK(moves() == before + 2);
    CHECK(world.value<Region>(entity) == Region{4, 0});
    CHECK(world.get<const Position>(entity).z == 3);
}

TEST_CASE("shared: another value is a change, but observers are not called") {
    World world;
    std::vector<std::string> log;
    world.on_add<Region>([&](World& w, std::span<const Entity> entities) {
        log.push_back("add " + std::to_string(w.value<Region>(entities[0]).id));
    });
    world.on_remove<Region>([&](World& w, std::span<const Entity> entities) {
        log.push_back("remove " + std::to_string(w.value<Region>(entities[0]).id));
    });
    const Entity entity = world.create(Region{1, 0}, Position{});
    world.create(Region{2, 0}, Position{});
    std::uint32_t since = world.version();
    const auto changed = [&] {
        std::vector<Entity> entities;
        world.query<const Region, Changed<Region>>().since(since).each(
            [&](Entity e, const Region&) { entities.push_back(e); });
        since = world.version();
        return entities;
    };
    CHECK(changed().empty());
    world.query<const Region, const Position>().each([](const Region&, const Position&) {});
    world.query<Position>().each([](Position&) {});
    CHECK(changed().empty());
    world.set(entity, Region{3, 0});
    CHECK(changed() == std::vector<Entity>{entity});
    world.remove<Region>(entity);
    world.add(entity, Region{5, 0});
    world.destroy(entity);
    world.clear();
    const std::vector<std::string> expected = {"add 1", "add 2",    "remove 3",
                                               "add 5", "remove 5", "remove 2"};
    CHECK(log == expected);
}

TEST_CASE("shared: a thousand values are a thousand batches without missing rows") {
    World world;
    constexpr std::uint32_t kKeys = 1000;
    std::vector<Entity> entities;
    for (std::uint32_t i = 0; i < 3 * kKeys; ++i) {
        entities.push_back(
            world.create(Region{i % kKeys, 0}, Position{static_cast<float>(i), 0, 0}));
    }
    double sum = 0;
    std::uint32_t chunks = 0;
    world.query<const Position, const Region>().chunks(
        [&](ChunkView, std::span<const Position> positions, const Region& key) {
            ++chunks;
            for (const Position& p : positions) {
                CHECK(static_cast<std::uint32_t>(p.x) % kKeys == key.id);
                sum += p.x;
            }
        });
    CHECK(chunks == kKeys);
    CHECK(sum == 0.5 * (3.0 * kKeys - 1) * (3.0 * kKeys));
    for (std::uint32_t i = 0; i < entities.size(); ++i) {
        world.set(entities[i], Region{0, 7});
    }
    CHECK(world.query<const Region>().chunk_count() == 3);
    CHECK(world.query<With<Position>>().where(Region{0, 7}).count() == 3 * kKeys);
}

TEST_CASE("shared: an optional component is null if it is missing") {
    World world;
    const Entity with = world.create(Position{}, Region{4, 0});
    world.create(Position{});
    world.query<const Position, Optional<const Region>>().each(
        [&](Entity entity, const Position&, const Region* key) {
            CHECK((key != nullptr) == (entity == with));
        });
    std::size_t found = 0;
    world.query<const Position, Optional<const Region>>().chunks(
        [&](ChunkView, std::span<const Position>, const Region* key) {
            found += key != nullptr ? key->id : 0;
        });
    CHECK(found == 4);
}

TEST_CASE("shared: snapshots restore batches and their order, and equal worlds have equal hashes") {
    register_component<Region>();
    register_component<Parent>();
    for (const std::uint32_t size : {1u, 1023u, 1024u, 1025u, 2047u, 2048u, 2049u}) {
        CAPTURE(size);
        World world;
        World again;
        for (World* one : {&world, &again}) {
            for (std::uint32_t i = 0; i < size; ++i) {
                const Entity entity = one->create(Region{i % 3, 0});
                if (i % 5 == 0) {
                    one->add(entity, Parent{});
                }
            }
        }
        CHECK(state_hash(world) == state_hash(again));
        again.set(
            again.query<const Region>().where(Region{0, 0}).count() > 0
                ? again.archetypes()[1]->entities()[0]
                : Entity{},
            Region{9, 9});
        CHECK(state_hash(world) != state_hash(again));

        const std::vector<std::byte> saved = *save_snapshot(world);
        World restored;
        for (const std::uint32_t id : {77u, 2u, 0u}) {
            restored.create(Region{id, 0});  // other values, other order: must be forgotten
        }
        REQUIRE(restore_snapshot(restored, saved).ok());
        CHECK(state_hash(restored) == state_hash(world));
        CHECK(*save_snapshot(restored) == saved);
        std::vector<Entity> order;
        std::vector<Entity> restored_order;
        world.query<const Region>().each([&](Entity e, const Region&) { order.push_back(e); });
        restored.query<const Region>().each(
            [&](Entity e, const Region&) { restored_order.push_back(e); });
        CHECK(order == restored_order);
        CHECK(restored.query<With<Region>>().where(Region{77, 0}).empty());
    }
}

TEST_CASE("shared: prefabs, statistics and code without types know the value") {
    World world;
    const Entity root = world.create(Region{6, 1}, Position{});
    for (const Entity copy : spawn(world, make_prefab(world, root), 3)) {
        CHECK(world.value<Region>(copy) == Region{6, 1});
    }
    CHECK(world.query<const Region>().where(Region{6, 1}).count() == 4);
    Region raw;
    CHECK(world.read(root, component_id<Region>, &raw));
    CHECK(raw == Region{6, 1});
    const World& reader = world;
    CHECK(static_cast<const Region*>(reader.find(root, component_id<Region>))->id == 6);
    CHECK(contains(to_text(world_stats(world)), "region(id=6 layer=1)"));
    CHECK(contains(
        stop_message([&] { static_cast<void>(world.find(root, component_id<Region>)); }),
        "use read and write"));
    CHECK(contains(
        stop_message([&] {
            world.query<const Region>().each([&](Entity entity, const Region&) {
                world.set(entity, Region{8, 8});
            });
        }),
        "structural change"));
}

TEST_CASE("shared: AnyOf visits entities with at least one of its components") {
    World world;
    std::vector<Entity> expected;
    for (unsigned bits = 0; bits < 16; ++bits) {
        const Entity entity = world.create(Position{});
        if ((bits & 1) != 0) {
            world.add(entity, Velocity{});
        }
        if ((bits & 2) != 0) {
            world.add(entity, Region{bits, 0});
        }
        if ((bits & 4) != 0) {
            world.add(entity, Heat{});
        }
        if ((bits & 8) != 0) {
            world.add(entity, Marked{});
        }
    }
    const auto check = [&]<typename... Terms>(Query<Terms...> query, const auto& wanted) {
        std::size_t count = 0;
        world.each_entity([&](Entity entity) {
            CHECK(query.contains(entity) == wanted(entity));
            count += wanted(entity) ? 1 : 0;
        });
        CHECK(query.count() == count);
    };
    check(world.query<const Position, AnyOf<Velocity, Marked>>(), [&](Entity e) {
        return world.has<Velocity>(e) || world.has<Marked>(e);
    });
    check(world.query<const Position, AnyOf<Velocity, Heat>>(), [&](Entity e) {
        return world.has<Velocity>(e) || world.has<Heat>(e);
    });
    check(
        world.query<AnyOf<Velocity, Region>, AnyOf<Marked, Heat>, Without<Mass>>(), [&](Entity e) {
            return (world.has<Velocity>(e) || world.has<Region>(e))
                   && (world.has<Marked>(e) || world.has<Heat>(e));
        });
    check(world.query<AnyOf<Heat>>(), [&](Entity e) { return world.has<Heat>(e); });
    world.query<const Position, AnyOf<Velocity, Marked>>().chunks(
        [](ChunkView chunk, std::span<const Position>) {
            CHECK((chunk.has<Velocity>() || chunk.has<Marked>()));
        });
}

}  // namespace shared_test
