#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/system.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace row_tracking_test {

using namespace limn;

struct Shown {
    int value = 0;
};
struct ShownIfOn {
    int value = 0;
};
struct ShownLanes {
    float x = 0;
    float y = 0;
};
struct Chosen {};
struct Warm {
    int degrees = 0;
};

}  // namespace row_tracking_test

template <>
struct limn::ComponentTraits<row_tracking_test::Shown> : limn::DefaultTraits {
    static constexpr bool tracks_rows = true;
};
template <>
struct limn::ComponentTraits<row_tracking_test::ShownIfOn> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
    static constexpr bool tracks_rows = true;
};
template <>
struct limn::ComponentTraits<row_tracking_test::ShownLanes> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
    static constexpr bool tracks_rows = true;
};
template <>
struct limn::ComponentTraits<row_tracking_test::Warm> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

namespace row_tracking_test {

/// The rows that were taken, counted over the chunks of the query.
template <typename T>
std::vector<std::uint32_t> take(World& world) {
    std::vector<std::uint32_t> rows;
    world.query<TakeRows<T>>().chunks([&](ChunkView chunk, const RowMask& taken) {
        taken.for_each([&](std::uint32_t row) { rows.push_back(chunk.offset() + row); });
    });
    return rows;
}

using Rows = std::vector<std::uint32_t>;

Rows range(std::uint32_t begin, std::uint32_t end) {
    Rows rows;
    for (std::uint32_t row = begin; row < end; ++row) {
        rows.push_back(row);
    }
    return rows;
}

/// What is in a row: whose it is, the value, and whether it is enabled.
struct Cell {
    Entity entity;
    int value;
    bool enabled;
    bool operator==(const Cell&) const = default;
};

/// A copy of a component's rows, as a renderer keeps one; it reads only the rows it takes.
template <typename T>
class Mirror {
  public:
    void update(World& world) {
        world.query<TakeRows<T>>().chunks([&](ChunkView chunk, const RowMask& taken) {
            std::vector<Cell>& rows = cells_[&chunk.archetype()];
            rows.resize(chunk.archetype().size());
            taken.for_each([&](std::uint32_t row) {
                rows[chunk.first_row() + row] = cell(world, chunk.entities()[row]);
            });
        });
    }
    /// How many rows differ from the world's.
    [[nodiscard]] std::size_t mistakes(const World& world) const {
        std::size_t found = 0;
        for (const auto& archetype : world.archetypes()) {
            if (!archetype->has(component_id<T>) || archetype->size() == 0) {
                continue;
            }
            const std::vector<Cell>& rows = cells_.at(archetype.get());
            for (std::uint32_t row = 0; row < archetype->size(); ++row) {
                found += rows[row] == cell(world, archetype->entities()[row]) ? 0 : 1;
            }
        }
        return found;
    }

  private:
    static Cell cell(const World& world, Entity entity) {
        const T value = world.value<T>(entity);
        if constexpr (requires { value.value; }) {
            return {entity, value.value, world.is_enabled<T>(entity)};
        } else {
            return {entity, static_cast<int>(value.x * 1000 + value.y), true};
        }
    }
    std::map<const Archetype*, std::vector<Cell>> cells_;
};

void write_chosen(Query<Shown, ShownIfOn, With<Chosen>> rows) {
    rows.par_each([](Shown& shown, ShownIfOn& on) {
        shown.value += 1;
        on.value += 2;
    });
}
void write_warm(Query<Shown, Optional<ShownIfOn>, const Warm> rows) {
    rows.par_each([](Shown& shown, ShownIfOn* on, const Warm& warm) {
        shown.value += warm.degrees;
        if (on != nullptr) {
            on->value += 1;
        }
    });
}
void write_split(Query<ShownLanes, Without<Chosen>> rows) {
    rows.each([](ShownLanes& lanes) { lanes.x += 1; });
}

/// Every kind of change, at random.
void change_something(World& world, std::vector<Entity>& entities, Random& random) {
    const std::size_t index = random.below(static_cast<std::uint32_t>(entities.size()));
    const Entity entity = entities[index];
    const int value = static_cast<int>(random.below(100));
    switch (random.below(20)) {
    case 0:
        entities.push_back(world.create(Shown{value}, ShownIfOn{value}, ShownLanes{1, 2}));
        break;
    case 1:
        entities.push_back(world.create(Shown{value}, ShownIfOn{value}, Chosen{}));
        break;
    case 2:
    case 3:
        if (entities.size() > 1020) {
            world.destroy(entity);
            entities[index] = entities.back();
            entities.pop_back();
        }
        break;
    case 4:
        world.add(entity, Chosen{});
        break;
    case 5:
        world.remove<Chosen>(entity);
        break;
    case 6:
        world.add(entity, Shown{value});
        break;
    case 7:
        world.add(entity, ShownLanes{static_cast<float>(value), 3});
        break;
    case 8:
        world.remove<ShownLanes>(entity);
        break;
    case 9:
        world.add(entity, Warm{value});
        break;
    case 10:
        world.remove<Warm>(entity);
        break;
    case 11:
        world.set_enabled<ShownIfOn>(entity, value % 2 == 0);
        break;
    case 12:
        if (ShownIfOn* on = world.query<ShownIfOn>().find<ShownIfOn>(entity); on != nullptr) {
            on->value = value;
        }
        break;
    case 13:
        if (world.has<ShownLanes>(entity)) {
            world.set(entity, ShownLanes{1, static_cast<float>(value)});
        }
        break;
    case 14:
        world.run([&](Commands commands) {
            commands.set(entity, Shown{value});
            commands.set_enabled<ShownIfOn>(entity, value % 2 == 1);
            commands.add(entity, ShownLanes{static_cast<float>(value), 4});
        });
        break;
    case 15:
        static_cast<Shown*>(world.find(entity, component_id<Shown>))->value = value;
        break;
    case 16: {
        Shown shown{value};
        world.write(entity, component_id<Shown>, &shown);
        break;
    }
    case 17:
        if (value < 5) {
            world.run(write_chosen);
            world.run(write_split);
        } else if (value < 10) {
            world.run(write_warm);
        }
        break;
    default:
        world.get<Shown>(entity).value = value;
        break;
    }
}

}  // namespace row_tracking_test

using namespace row_tracking_test;

TEST_CASE("row tracking: a copy that reads only the taken rows never becomes outdated") {
    for (const std::uint64_t seed : {1, 2, 3}) {
        for (const std::size_t count : {1023u, 1024u, 1025u, 2049u}) {
            INFO("seed " << seed << ", count " << count);
            Random random(seed, count, 0, 0);
            World world;
            std::vector<Entity> entities;
            for (std::size_t i = 0; i < count; ++i) {
                entities.push_back(world.create(Shown{}, ShownIfOn{}));
            }
            Mirror<Shown> shown;
            Mirror<ShownIfOn> on;
            Mirror<ShownLanes> lanes;
            for (int i = 0; i < 3000; ++i) {
                change_something(world, entities, random);
                if (i % 50 == 0) {
                    shown.update(world);
                    on.update(world);
                    lanes.update(world);
                    REQUIRE(shown.mistakes(world) == 0);
                    REQUIRE(on.mistakes(world) == 0);
                    REQUIRE(lanes.mistakes(world) == 0);
                }
            }
        }
    }
}

TEST_CASE("row tracking: exactly the rows that were passed for writing are taken") {
    World world;
    const std::vector<Entity> entities =
        world.create_many(3000, Shown{}, ShownIfOn{}, ShownLanes{});
    CHECK(take<Shown>(world) == range(0, 3000));
    CHECK(take<Shown>(world).empty());
    CHECK(take<ShownIfOn>(world) == range(0, 3000));
    CHECK(take<ShownLanes>(world) == range(0, 3000));

    static_cast<void>(world.get<const Shown>(entities[4]));
    world.query<const Shown>().each([](const Shown&) {});
    CHECK(take<Shown>(world).empty());
    world.get<Shown>(entities[5]).value = 1;
    *world.find<Shown>(entities[1024]) = {2};
    world.query<Shown>().find<Shown>(entities[2999])->value = 3;
    CHECK(take<Shown>(world) == Rows{5, 1024, 2999});
    CHECK(take<ShownIfOn>(world).empty());

    for (std::size_t i = 0; i < 3000; ++i) {
        world.set_enabled<ShownIfOn>(entities[i], i % 3 == 0);
    }
    CHECK(take<ShownIfOn>(world).size() == 2000);
    world.query<Shown, Optional<ShownIfOn>>().each([](Shown&, ShownIfOn*) {});
    CHECK(take<Shown>(world) == range(0, 3000));
    Rows thirds;
    for (std::uint32_t row = 0; row < 3000; row += 3) {
        thirds.push_back(row);
    }
    CHECK(take<ShownIfOn>(world) == thirds);
    world.query<Shown, With<ShownIfOn>>().par_each([](Shown&) {});
    CHECK(take<Shown>(world) == thirds);

    world.add(entities[6], Warm{});
    world.add(entities[7], Warm{});
    world.query<Shown, const Warm>().each([](Shown&, const Warm&) {});
    CHECK(take<Shown>(world) == Rows{6, 7});
    world.query<Shown, const Warm, With<ShownIfOn>>().each([](Shown&, const Warm&) {});
    CHECK(take<Shown>(world) == Rows{6});
    world.query<Shown, Without<Warm>, Without<ShownIfOn>>().each([](Shown&) {});
    CHECK(take<Shown>(world).size() == 1999);

    world.set(entities[8], ShownLanes{1, 2});
    world.query<ShownLanes>().set(entities[9], ShownLanes{1, 2});
    CHECK(take<ShownLanes>(world) == Rows{8, 9});
}

TEST_CASE("row tracking: added and moved rows are marked at their new position") {
    World world;
    const std::vector<Entity> entities = world.create_many(2050, Shown{});
    static_cast<void>(take<Shown>(world));
    world.destroy(entities[10]);  // replaced by the last row
    CHECK(take<Shown>(world) == Rows{10});
    world.destroy(entities[2048]);  // the last itself
    CHECK(take<Shown>(world).empty());
    world.create(Shown{});
    CHECK(take<Shown>(world) == Rows{2048});
    world.add(entities[20], Chosen{});  // to another archetype; the last row replaces it
    CHECK(take<Shown>(world) == Rows{20, 2048});
    world.clear();
    CHECK(take<Shown>(world).empty());
    world.create(Shown{});
    CHECK(take<Shown>(world) == Rows{0});
}

TEST_CASE("row tracking: chunks() writes all rows, unless the function says which, or none") {
    World world;
    world.create_many(3000, Shown{}, ShownIfOn{});
    static_cast<void>(take<Shown>(world));
    static_cast<void>(take<ShownIfOn>(world));
    const auto some = [](Query<Shown, ShownIfOn> query) {
        query.par_chunks([](ChunkView chunk, std::span<Shown>, std::span<ShownIfOn>) {
            RowMask rows{};
            rows.set(3);
            rows.set(100);
            if (chunk.index() == 0) {
                chunk.mark_rows<Shown>(rows);
                chunk.mark_rows<ShownIfOn>(RowMask{});
            } else if (chunk.index() == 1) {
                chunk.mark_unchanged<Shown>();
            }
        });
    };
    world.run(some);
    Rows expected{3, 100};
    for (const std::uint32_t row : range(2048, 3000)) {
        expected.push_back(row);
    }
    CHECK(take<Shown>(world) == expected);
    CHECK(take<ShownIfOn>(world) == range(1024, 3000));
    // What was marked before stays marked.
    world.get<Shown>(world.archetypes().back()->entities()[7]).value = 1;
    world.run(some);
    expected.insert(expected.begin() + 1, 7);
    CHECK(take<Shown>(world) == expected);
}

TEST_CASE("row tracking: the same rows for any number of threads") {
    const int threads = thread_count();
    std::vector<Rows> taken;
    for (const int count : {1, 2, 7}) {
        set_thread_count(count);
        World world;
        Random random(5, 0, 0, 0);
        std::vector<Entity> entities;
        for (int i = 0; i < 20'000; ++i) {
            entities.push_back(world.create(Shown{}, ShownIfOn{}, Chosen{}));
            if (random.below(2) == 0) {
                world.disable<ShownIfOn>(entities.back());
            }
        }
        for (int i = 0; i < 8000; ++i) {
            const Entity entity = entities[random.below(20'000)];
            if (!world.has<Warm>(entity)) {
                world.add(entity, Warm{});
            }
        }
        static_cast<void>(take<Shown>(world));
        world.run(write_warm);
        taken.push_back(take<Shown>(world));
        CHECK(taken.back().size() == world.query<const Warm>().count());
        world.run(write_chosen);
        CHECK(take<Shown>(world).size() == world.query<With<ShownIfOn>>().count());
    }
    set_thread_count(threads);
    CHECK(taken[1] == taken[0]);
    CHECK(taken[2] == taken[0]);
}

TEST_CASE("row tracking: TakeRows counts as writing, and marks no version") {
    static constexpr auto taker = [](Query<TakeRows<Shown>> query) {
        query.chunks([](ChunkView, const RowMask&) {});
    };
    static constexpr auto reader = [](Query<const Shown> query) {
        query.each([](const Shown&) {});
    };
    const SystemAccess takes = make_system("taker", taker).access();
    const SystemAccess reads = make_system("reader", reader).access();
    CHECK(takes.conflicts_with(reads));
    CHECK(takes.conflicts_with(takes));
    CHECK_FALSE(reads.conflicts_with(reads));
    World world;
    world.create_many(2000, Shown{});
    const std::uint32_t before = world.version();
    world.run(taker);
    CHECK(world.query<Changed<Shown>>().since(before).empty());
}
