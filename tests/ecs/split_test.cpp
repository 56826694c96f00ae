#include "ecs/base/hash.h"
#include "ecs/base/math.h"
#include "ecs/component_bytes.h"
#include "ecs/prefab.h"
#include "ecs/snapshot.h"
#include "ecs/snapshot_format.h"
#include "ecs/world.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <random>
#include <string>
#include <vector>

// Split storage against the same component in a table: whatever is done to a world, nobody who
// looks at values may see which of the two it is.

using namespace limn;
using namespace limn::test;

namespace {

/// One type twice: split, and the reference in a table. The names are equally long, so that
/// snapshots are too.
template <Storage storage>
struct Ball {
    Vec3 center = {1, 2, 3};
    float radius = 0.5f;
    std::int32_t group = -7;
    std::uint32_t weights[2] = {4, 5};

    bool operator==(const Ball&) const = default;
};
struct BallSplit : Ball<Storage::Split> {};
struct BallTable : Ball<Storage::Table> {};

template <typename Visitor>
void visit_ball(auto& ball, Visitor&& visit) {
    visit("center", ball.center);
    visit("radius", ball.radius);
    visit("group", ball.group);
    visit("weights", ball.weights);
}
template <typename Visitor>
void visit_fields(BallSplit& ball, Visitor&& visit) {
    visit_ball(ball, visit);
}
template <typename Visitor>
void visit_fields(BallTable& ball, Visitor&& visit) {
    visit_ball(ball, visit);
}

/// Split, of one scalar, without fields that anybody knows.
struct Charge {
    float value = 0;
};

/// A ball that no other number makes.
template <typename T>
T ball(int number) {
    const float x = static_cast<float>(number);
    T made;
    made.center = {x, x + 0.25f, -x};
    made.radius = 1.0f / (x + 1.0f);
    made.group = number * 3;
    made.weights[0] = static_cast<std::uint32_t>(number);
    made.weights[1] = ~static_cast<std::uint32_t>(number);
    return made;
}

template <typename A, typename B>
bool same(const A& a, const B& b) {
    static_assert(sizeof(A) == sizeof(B));
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool contains(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

/// The row counts at which chunks and vectors begin and end.
constexpr std::uint32_t kSizes[] = {1,    15,   16,   17,   63,   64,   500,  1023,
                                    1024, 1025, 2047, 2048, 2049, 4095, 4096, 4097};

}  // namespace

template <>
struct limn::ComponentTraits<BallSplit> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<Charge> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};

namespace {

// ---- the same operations on two worlds
// -----------------------------------------------------------

class Twins {
  public:
    explicit Twins(unsigned seed) : random_(seed) {}

    void run(int operations) {
        for (int i = 0; i < operations; ++i) {
            step(i);
            if (i % 97 == 0) {
                compare();
            }
        }
        compare();
    }

  private:
    int roll(int sides) { return static_cast<int>(random_() % static_cast<unsigned>(sides)); }
    Entity pick() {
        return entities_.empty()
                   ? Entity{}
                   : entities_[static_cast<std::size_t>(roll(static_cast<int>(entities_.size())))];
    }

    void step(int number) {
        const int kind = roll(14);
        if (kind <= 1 || entities_.empty()) {
            const bool has_label = roll(2) == 0;
            entities_.push_back(create<BallSplit>(split_, number, has_label));
            REQUIRE(create<BallTable>(table_, number, has_label) == entities_.back());
            return;
        }
        const Entity entity = pick();
        const int seed = roll(1 << 20);
        const auto both = [&](const auto& act) {
            act.template operator()<BallSplit>(split_);
            act.template operator()<BallTable>(table_);
        };
        switch (kind) {
        case 2:
            both([&]<typename T>(World& world) {
                const std::vector<Entity> made =
                    world.create_many(static_cast<std::size_t>(seed % 300), ball<T>(number));
                if constexpr (std::is_same_v<T, BallSplit>) {
                    entities_.insert(entities_.end(), made.begin(), made.end());
                }
            });
            break;
        case 3:
            both([&]<typename T>(World& world) { world.destroy(entity); });
            std::erase(entities_, entity);
            break;
        case 4:
            both([&]<typename T>(World& world) { world.add(entity, ball<T>(number)); });
            break;
        case 5:
            both([&]<typename T>(World& world) { world.template remove<T>(entity); });
            break;
        case 6:
            both([&]<typename T>(World& world) { world.add(entity, Position{1, 2, 3}); });
            break;
        case 7:
            both([&]<typename T>(World& world) { world.template remove<Position>(entity); });
            break;
        case 8:
            both([&]<typename T>(World& world) { world.add(entity, component_id<T>); });
            break;
        case 9:
            both([&]<typename T>(World& world) {
                T value = ball<T>(number);
                world.write(entity, component_id<T>, &value);
            });
            break;
        case 10:
            both([&]<typename T>(World& world) {
                if (world.template has<T>(entity)) {
                    world.set(entity, ball<T>(number));
                }
            });
            break;
        case 11:
            both([&]<typename T>(World& world) {
                world.template query<T>().each([](Entity e, T& value) {
                    value.radius += static_cast<float>(e.index);
                    value.group ^= 1;
                });
            });
            break;
        default:
            record(seed);
        }
    }

    template <typename T>
    static Entity create(World& world, int number, bool has_label) {
        return has_label ? world.create(ball<T>(number), Label{"label", {number}})
                         : world.create(ball<T>(number));
    }

    void record(int seed) {
        const auto act = [&]<typename T>(World& world) {
            std::mt19937 random(static_cast<unsigned>(seed));
            CommandBuffer buffer;
            const Commands commands(buffer);
            for (int i = 0; i < 20; ++i) {
                const Entity entity = entities_[random() % entities_.size()];
                switch (random() % 5) {
                case 0:
                    commands.add(entity, ball<T>(i));
                    break;
                case 1:
                    commands.set(entity, ball<T>(i + 100));
                    break;
                case 2:
                    commands.remove<T>(entity);
                    break;
                case 3:
                    commands.add_default(entity, component_id<T>);
                    break;
                default:
                    commands.create(ball<T>(i), Marked{});
                }
            }
            CommandBuffer* const buffers[] = {&buffer};
            apply_commands(world, buffers);
        };
        act.template operator()<BallSplit>(split_);
        act.template operator()<BallTable>(table_);
    }

    void compare() {
        REQUIRE(split_.entity_count() == table_.entity_count());
        std::vector<Entity> order;
        std::vector<BallTable> values;
        std::as_const(table_).query<const BallTable>().each(
            [&](Entity entity, const BallTable& value) {
                order.push_back(entity);
                values.push_back(value);
            });
        std::size_t i = 0;
        bool is_same = true;
        std::as_const(split_).query<const BallSplit>().each([&](Entity entity,
                                                                const BallSplit& value) {
            is_same = is_same && i < order.size() && order[i] == entity && same(values[i], value)
                      && same(values[i], split_.value<BallSplit>(entity));
            ++i;
        });
        CHECK(is_same);
        CHECK(i == order.size());
        compare_columns();
    }

    /// The bytes that snapshots and hashes are made of.
    void compare_columns() {
        REQUIRE(split_.archetypes().size() == table_.archetypes().size());
        for (std::size_t i = 0; i < split_.archetypes().size(); ++i) {
            const Archetype& a = *split_.archetypes()[i];
            const Archetype& b = *table_.archetypes()[i];
            const int split_column = a.column_of(component_id<BallSplit>);
            const int table_column = b.column_of(component_id<BallTable>);
            REQUIRE(a.size() == b.size());
            REQUIRE((split_column >= 0) == (table_column >= 0));
            if (split_column < 0) {
                continue;
            }
            ByteWriter split_bytes;
            ByteWriter table_bytes;
            write_rows(a.column(split_column), 0, a.size(), split_bytes);
            write_rows(b.column(table_column), 0, b.size(), table_bytes);
            REQUIRE(split_bytes.size() == table_bytes.size());
            CHECK(
                hash_bytes(split_bytes.data(), split_bytes.size())
                == hash_bytes(table_bytes.data(), table_bytes.size()));
            const std::uint32_t rows = std::min(a.size(), kChunkRows);
            CHECK(
                hash_rows(a.column(split_column), 0, rows, 1)
                == hash_rows(b.column(table_column), 0, rows, 1));
        }
    }

    std::mt19937 random_;
    World split_;
    World table_;
    std::vector<Entity> entities_;
};

TEST_CASE("split: no sequence of operations distinguishes a split component from one in a table") {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        CAPTURE(seed);
        Twins(seed).run(700);
    }
}

// ---- lanes
// ---------------------------------------------------------------------------------------

TEST_CASE("split: lanes are aligned, padded to 16 rows and hold the members in their order") {
    for (const std::uint32_t size : kSizes) {
        CAPTURE(size);
        World world;
        std::vector<Entity> entities;
        for (std::uint32_t i = 0; i < size; ++i) {
            entities.push_back(world.create(ball<BallSplit>(static_cast<int>(i)), Position{}));
        }
        std::uint32_t seen = 0;
        bool is_right = true;
        world.query<BallSplit>().chunks([&](ChunkView chunk, SplitSpan<BallSplit> balls) {
            REQUIRE(balls.size() == chunk.size());
            const auto center = balls.field<&BallSplit::center>();
            const std::span<float> radius = balls.field<&BallSplit::radius>();
            const std::span<std::int32_t> group = balls.field<&BallSplit::group>();
            const auto weights = balls.field<&BallSplit::weights>();
            static_assert(std::tuple_size_v<decltype(center)> == 3);
            static_assert(std::tuple_size_v<decltype(weights)> == 2);
            static_assert(std::is_same_v<decltype(weights)::value_type, std::span<std::uint32_t>>);
            for (std::size_t lane = 0; lane < SplitSpan<BallSplit>::kLanes; ++lane) {
                const auto address = reinterpret_cast<std::uintptr_t>(balls.lane(lane).data());
                CHECK(address % kColumnAlign == 0);
                // Writing the padding must neither fault nor touch another lane.
                for (std::uint32_t i = chunk.size(); i % kRowPadding != 0; ++i) {
                    std::memset(balls.lane(lane).data() + i, 0xee, sizeof(float));
                }
            }
            CHECK(center[1].data() == balls.lane(1).data());
            CHECK(radius.data() == balls.lane(3).data());
            CHECK(group.data() == balls.lane<std::int32_t>(4).data());
            for (std::uint32_t i = 0; i < chunk.size(); ++i, ++seen) {
                const BallSplit expected = ball<BallSplit>(static_cast<int>(seen));
                is_right = is_right && same(balls[i], expected) && center[0][i] == expected.center.x
                           && center[2][i] == expected.center.z && radius[i] == expected.radius
                           && group[i] == expected.group && weights[1][i] == expected.weights[1];
                balls.set(i, ball<BallSplit>(static_cast<int>(seen) + 1));
            }
        });
        CHECK(is_right);
        CHECK(seen == size);
        for (std::uint32_t i = 0; i < size; ++i) {
            is_right =
                is_right
                && same(
                    world.value<BallSplit>(entities[i]), ball<BallSplit>(static_cast<int>(i) + 1));
        }
        CHECK(is_right);
    }
}

TEST_CASE("split: each, chunks and their parallel forms write the same values") {
    for (const std::uint32_t size : kSizes) {
        CAPTURE(size);
        World worlds[4];
        for (World& world : worlds) {
            for (std::uint32_t i = 0; i < size; ++i) {
                world.create(ball<BallSplit>(static_cast<int>(i)), Charge{static_cast<float>(i)});
            }
        }
        const auto row = [](BallSplit& value, const Charge& charge) {
            value.radius += charge.value;
            value.center.y *= 2;
        };
        const auto chunk = [](ChunkView, SplitSpan<BallSplit> balls,
                              SplitSpan<const Charge> charges) {
            const std::span<float> radius = balls.field<&BallSplit::radius>();
            const std::span<float> y = balls.lane(1);
            const std::span<const float> charge = charges.lane(0);
            for (std::size_t i = 0; i < radius.size(); ++i) {
                radius[i] += charge[i];
                y[i] *= 2;
            }
        };
        worlds[0].query<BallSplit, const Charge>().each(row);
        worlds[1].query<BallSplit, const Charge>().par_each(row);
        worlds[2].query<BallSplit, const Charge>().chunks(chunk);
        worlds[3].query<BallSplit, const Charge>().par_chunks(chunk);
        for (World& world : worlds) {
            CHECK(state_hash(world) == state_hash(worlds[0]));
        }
        CHECK(worlds[0].query<const BallSplit>().count() == size);
    }
}

TEST_CASE("split: an optional component is null or empty if it is missing") {
    World world;
    const Entity with = world.create(Position{}, ball<BallSplit>(5));
    const Entity without = world.create(Position{});
    world.query<const Position, Optional<BallSplit>>().each(
        [&](Entity entity, const Position&, BallSplit* value) {
            CHECK((value != nullptr) == (entity == with));
            if (value != nullptr) {
                value->radius = 9;
            }
        });
    CHECK(world.value<BallSplit>(with).radius == 9);
    CHECK_FALSE(world.has<BallSplit>(without));
    world.query<const Position, Optional<const BallSplit>>().chunks(
        [&](ChunkView chunk, std::span<const Position>, SplitSpan<const BallSplit> balls) {
            CHECK(balls.empty() == !chunk.has<BallSplit>());
        });
}

// ---- single values
// -------------------------------------------------------------------------------

TEST_CASE("split: value, set, read and write copy, and stop if there is none") {
    World world;
    const Entity entity = world.create(ball<BallSplit>(1));
    const Entity bare = world.create(Position{});
    world.set(entity, ball<BallSplit>(2));
    CHECK(same(world.value<BallSplit>(entity), ball<BallSplit>(2)));
    const auto query = world.query<BallSplit>();
    CHECK(same(query.value<BallSplit>(entity), ball<BallSplit>(2)));
    query.set(entity, ball<BallSplit>(3));

    BallSplit raw;
    CHECK(world.read(entity, component_id<BallSplit>, &raw));
    CHECK(same(raw, ball<BallSplit>(3)));
    CHECK_FALSE(world.read(bare, component_id<BallSplit>, &raw));
    CHECK_FALSE(world.write(bare, component_id<BallSplit>, &raw));
    CHECK_FALSE(world.has<BallSplit>(bare));

    const auto says_name = [](const auto& act) {
        return contains(stop_message(act), "ball_split");
    };
    CHECK(says_name([&] { static_cast<void>(world.value<BallSplit>(bare)); }));
    CHECK(says_name([&] { world.set(bare, BallSplit{}); }));
    CHECK(says_name([&] { static_cast<void>(query.value<BallSplit>(bare)); }));
    CHECK(contains(
        stop_message([&] { static_cast<void>(world.find(entity, component_id<BallSplit>)); }),
        "no address"));
}

TEST_CASE("split: value, set, read and write work for every other kind of storage too") {
    World world;
    const Entity entity = world.create(Label{"a", {1}}, Note{"b"}, Marked{});
    world.set(entity, Label{"c", {2, 3}});
    world.set(entity, Note{"d"});
    world.set(entity, Marked{});
    CHECK(world.value<Label>(entity).text == "c");
    CHECK(world.value<Note>(entity).text == "d");
    Label label{"e", {}};
    CHECK(world.write(entity, component_id<Label>, &label));
    alignas(Note) std::byte raw[sizeof(Note)];
    CHECK(world.read(entity, component_id<Note>, raw));
    Note* const note = std::launder(reinterpret_cast<Note*>(raw));
    CHECK(note->text == "d");
    note->~Note();
    CHECK(world.get<const Label>(entity).text == "e");
    CHECK(world.read(entity, component_id<Marked>, nullptr));
}

// ---- changes and observers
// -----------------------------------------------------------------------

TEST_CASE("split: writing is a change of its chunk, reading is none") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 3000; ++i) {
        entities.push_back(world.create(ball<BallSplit>(i)));
    }
    const auto changed = [&](const auto& act) {
        const std::uint32_t before = world.version();
        act();
        std::uint32_t chunks = 0;
        world.query<const BallSplit, Changed<BallSplit>>().since(before).chunks(
            [&](ChunkView, SplitSpan<const BallSplit>) { ++chunks; });
        return chunks;
    };
    CHECK(changed([] {}) == 0);
    CHECK(changed([&] { static_cast<void>(world.value<BallSplit>(entities[0])); }) == 0);
    CHECK(changed([&] { world.query<const BallSplit>().each([](const BallSplit&) {}); }) == 0);
    CHECK(changed([&] { world.set(entities[1500], BallSplit{}); }) == 1);
    CHECK(changed([&] { world.query<BallSplit>().set(entities[0], BallSplit{}); }) == 1);
    CHECK(
        changed([&] {
            BallSplit value;
            world.write(entities[2999], component_id<BallSplit>, &value);
        })
        == 1);
    CHECK(changed([&] { world.query<BallSplit>().each([](BallSplit&) {}); }) == 3);
    CHECK(
        changed([&] {
            world.query<BallSplit>().chunks([](ChunkView chunk, SplitSpan<BallSplit>) {
                if (chunk.index() != 1) {
                    chunk.mark_unchanged<BallSplit>();
                }
            });
        })
        == 1);
    CHECK(
        changed([&] {
            CommandBuffer buffer;
            Commands(buffer).set(entities[2000], BallSplit{});
            CommandBuffer* const buffers[] = {&buffer};
            apply_commands(world, buffers);
        })
        == 1);
}

TEST_CASE("split: observers are called when it is added and removed, not for new values") {
    World world;
    std::vector<std::string> log;
    world.on_add<BallSplit>([&](World& w, std::span<const Entity> entities) {
        log.push_back("add " + std::to_string(w.value<BallSplit>(entities[0]).group));
    });
    world.on_remove<BallSplit>([&](World& w, std::span<const Entity> entities) {
        log.push_back("remove " + std::to_string(w.value<BallSplit>(entities[0]).group));
    });
    const Entity entity = world.create(ball<BallSplit>(1));
    world.set(entity, ball<BallSplit>(2));
    world.add(entity, ball<BallSplit>(3));
    world.remove<BallSplit>(entity);
    world.add(entity, ball<BallSplit>(4));
    world.destroy(entity);
    world.create_many(10, ball<BallSplit>(5));
    world.clear();
    CHECK(world.entity_count() == 0);
    const std::vector<std::string> expected = {"add 3",     "remove 9", "add 12",
                                               "remove 12", "add 15",   "remove 15"};
    CHECK(log == expected);
}

// ---- snapshots and prefabs
// -----------------------------------------------------------------------

/// The snapshot with another name of a component, as long as the old.
std::vector<std::byte>
renamed(std::vector<std::byte> bytes, std::string_view from, std::string_view to) {
    REQUIRE(from.size() == to.size());
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    std::memcpy(bytes.data() + at, to.data(), to.size());
    return bytes;
}

TEST_CASE("split: a snapshot has the same bytes as for a table component, and restores them") {
    register_component<BallSplit>();
    register_component<BallTable>();
    for (const std::uint32_t size : kSizes) {
        CAPTURE(size);
        World split;
        World table;
        for (std::uint32_t i = 0; i < size; ++i) {
            split.create(ball<BallSplit>(static_cast<int>(i)));
            table.create(ball<BallTable>(static_cast<int>(i)));
        }
        const std::vector<std::byte> saved = *save_snapshot(split);
        const std::vector<std::byte> other =
            renamed(*save_snapshot(table), "ball_table", "ball_split");
        REQUIRE(saved.size() == other.size());
        const std::size_t header = kSnapshotHeaderSize;
        CHECK(
            std::memcmp(saved.data() + header, other.data() + header, saved.size() - header) == 0);

        World restored;
        restored.create(ball<BallSplit>(-5));
        REQUIRE(restore_snapshot(restored, saved).ok());
        CHECK(state_hash(restored) == state_hash(split));
        CHECK(*save_snapshot(restored) == saved);
    }
}

TEST_CASE("split: a prefab keeps and spawns the values") {
    World world;
    const Entity root = world.create(ball<BallSplit>(11), Position{1, 2, 3});
    const Prefab prefab = make_prefab(world, root);
    for (const Entity copy : spawn(world, prefab, 3)) {
        CHECK(same(world.value<BallSplit>(copy), ball<BallSplit>(11)));
        CHECK(world.get<const Position>(copy).z == 3);
    }
}

}  // namespace
