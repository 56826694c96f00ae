#include "ecs/base/jobs.h"
#include "ecs/prefab.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "tests/complexity/work_counter.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

// Twice as many entities are at most 2.3 times the work: n log n and the growth of vectors are in
// it, a look at all others for each one is not. And what should allocate nothing does not.

namespace complexity_test {

using namespace limn;

struct Point {
    float x = 0, y = 0, z = 0;
};
struct Speed {
    float x = 0, y = 0, z = 0;
};
/// Moves by its own constructor, which counts.
struct Cargo {
    static inline std::uint64_t moves = 0;
    int value = 0;
    explicit Cargo(int v = 0) : value(v) {}
    Cargo(const Cargo&) = default;
    Cargo(Cargo&& other) noexcept : value(other.value) { ++moves; }
    Cargo& operator=(const Cargo&) = default;
    ~Cargo() { value = -1; }
};
template <typename Visitor>
void visit_fields(Cargo& cargo, Visitor&& visit) {
    visit("value", cargo.value, {.doc = "any"});
}
struct Extra {
    float values[4] = {};
};
struct Badge {};
/// Sparse.
struct Warmth {
    int degrees = 0;
};
struct Friend {
    Entity entity;
};
template <typename Visitor>
void visit_fields(Friend& link, Visitor&& visit) {
    visit("entity", link.entity, {.doc = "any"});
}
template <int number>
struct Flag {};

}  // namespace complexity_test

template <>
struct limn::ComponentTraits<complexity_test::Warmth> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

using namespace limn;
using namespace limn::test;
using namespace complexity_test;

namespace {

constexpr std::size_t kEntities = 12'000;

/// A world of n entities, in the order of creation and in another.
struct Crowd {
    World world;
    std::vector<Entity> entities;
    std::vector<Entity> shuffled;
    CommandBuffer buffer;

    explicit Crowd(std::size_t n) {
        register_component<Point>();
        register_component<Speed>();
        register_component<Cargo>();
        register_component<Warmth>();
        register_component<Parent>();
        entities = world.create_many(n, Point{}, Speed{}, Cargo(1));
        shuffled = entities;
        std::mt19937 random(7);
        std::shuffle(shuffled.begin(), shuffled.end(), random);
    }
    [[nodiscard]] Commands commands() { return Commands(buffer); }
    void flush() {
        CommandBuffer* const buffers[] = {&buffer};
        apply_commands(world, buffers);
    }
};

/// `run(crowd)` is measured with n and with 2 n entities; `prepare(crowd)` is not.
template <typename Prepare, typename Run>
void check_growth(
    const std::string& what, const Prepare& prepare, const Run& run, std::size_t n = kEntities) {
    Work work[2];
    for (std::size_t i = 0; i < 2; ++i) {
        Crowd crowd(n << i);
        prepare(crowd);
        work[i] = work_of([&] { run(crowd); });
    }
    const double blocks = static_cast<double>(work[1].blocks) / static_cast<double>(work[0].blocks);
    std::printf(
        "complexity: %-40s %7.1f blocks each, x %.2f, %7.1f heap bytes each\n", what.c_str(),
        static_cast<double>(work[0].blocks) / static_cast<double>(n), blocks,
        static_cast<double>(work[0].bytes) / static_cast<double>(n));
    CAPTURE(what);
    CHECK(blocks <= 2.3);
    CHECK(static_cast<double>(work[1].bytes) <= 2.3 * static_cast<double>(work[0].bytes) + 65536);
}

template <typename Run>
void check_growth(const std::string& what, const Run& run) {
    check_growth(
        what, [](Crowd&) {}, run);
}

struct OneThread {
    int before = thread_count();
    OneThread() { set_thread_count(1); }
    ~OneThread() { set_thread_count(before); }
};

/// n entities below the first: one below the other, or all beside each other.
void make_tree(Crowd& crowd, bool is_deep) {
    for (std::size_t i = 1; i < crowd.entities.size(); ++i) {
        const Entity parent = crowd.entities[is_deep ? i - 1 : 0];
        crowd.world.add(crowd.entities[i], Parent{parent, static_cast<std::uint32_t>(i)});
    }
}

}  // namespace

TEST_CASE("complexity: one at a time, the cost per entity does not depend on their number") {
    const OneThread one;
    check_growth("create", [](Crowd& crowd) {
        for (std::size_t i = 0; i < crowd.entities.size(); ++i) {
            crowd.world.create(Point{}, Cargo(1), Warmth{});
        }
    });
    check_growth("destroy in order", [](Crowd& crowd) {
        for (const Entity entity : crowd.entities) {
            crowd.world.destroy(entity);
        }
    });
    check_growth("destroy in another order", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.world.destroy(entity);
        }
    });
    check_growth("add and remove in another order", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.world.add(entity, Extra{});
        }
        for (const Entity entity : crowd.entities) {
            crowd.world.remove<Speed>(entity);
        }
    });
    check_growth("add and remove, sparse", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.world.add(entity, Warmth{3});
        }
        for (const Entity entity : crowd.entities) {
            crowd.world.remove<Warmth>(entity);
        }
    });
    check_growth(
        "add and remove, observed",
        [](Crowd& crowd) {
            crowd.world.on_add<Extra>([](World&, std::span<const Entity>) {});
            crowd.world.on_remove<Extra>([](World&, std::span<const Entity>) {});
        },
        [](Crowd& crowd) {
            for (const Entity entity : crowd.shuffled) {
                crowd.world.add(entity, Extra{});
            }
            for (const Entity entity : crowd.entities) {
                crowd.world.remove<Extra>(entity);
            }
        });
    check_growth("get", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.world.get<Point>(entity).x += 1;
        }
    });
}

TEST_CASE("complexity: bulk operations are linear in the number of entities") {
    const OneThread one;
    check_growth("create_many", [](Crowd& crowd) {
        static_cast<void>(
            crowd.world.create_many(crowd.entities.size(), Point{}, Cargo(3), Extra{}, Warmth{}));
    });
    check_growth("clear", [](Crowd& crowd) { crowd.world.clear(); });
    check_growth(
        "clear, observed",
        [](Crowd& crowd) { crowd.world.on_remove<Cargo>([](World&, std::span<const Entity>) {}); },
        [](Crowd& crowd) { crowd.world.clear(); });
    check_growth("each and chunks", [](Crowd& crowd) {
        crowd.world.query<Point, const Speed>().each(
            [](Point& point, const Speed& speed) { point.x += speed.x; });
        crowd.world.query<const Point, Changed<Point>>().each([](const Point&) {});
    });
}

TEST_CASE("complexity: recording and applying commands is linear in their number") {
    const OneThread one;
    check_growth("record", [](Crowd& crowd) {
        for (const Entity entity : crowd.entities) {
            crowd.commands().add(entity, Extra{});
            crowd.commands().add(entity, Cargo(2));
            crowd.commands().add(crowd.commands().create(Point{}), Badge{});
        }
    });
    const auto check_flush = [](const char* what, const auto& record) {
        check_growth(what, record, [](Crowd& crowd) { crowd.flush(); });
    };
    check_flush("flush: add in order", [](Crowd& crowd) {
        for (const Entity entity : crowd.entities) {
            crowd.commands().add(entity, Extra{});
        }
    });
    check_flush("flush: add in another order", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.commands().add(entity, Extra{});
        }
    });
    check_flush("flush: add to a random quarter", [](Crowd& crowd) {
        for (std::size_t i = 0; i < crowd.shuffled.size() / 4; ++i) {
            crowd.commands().add(crowd.shuffled[i], Extra{});
        }
    });
    check_flush("flush: remove in another order", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.commands().remove<Speed>(entity);
        }
    });
    check_flush("flush: set in another order", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.commands().set(entity, Cargo(5));
        }
    });
    check_flush("flush: sparse", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.commands().add(entity, Warmth{2});
        }
    });
    check_flush("flush: destroy in order", [](Crowd& crowd) {
        for (const Entity entity : crowd.entities) {
            crowd.commands().destroy(entity);
        }
    });
    check_flush("flush: destroy in another order", [](Crowd& crowd) {
        for (const Entity entity : crowd.shuffled) {
            crowd.commands().destroy(entity);
        }
    });
    check_flush("flush: create", [](Crowd& crowd) {
        for (std::size_t i = 0; i < crowd.entities.size(); ++i) {
            crowd.commands().create(Point{}, Cargo(2), Warmth{});
        }
    });
    check_flush("flush: create, linked to each other", [](Crowd& crowd) {
        Entity last;
        for (std::size_t i = 0; i < crowd.entities.size(); ++i) {
            last = crowd.commands().create(Point{}, Friend{last});
        }
    });
    check_flush("flush: all kinds for each", [](Crowd& crowd) {
        for (std::size_t i = 0; i < crowd.shuffled.size(); ++i) {
            const Entity entity = crowd.shuffled[i];
            crowd.commands().add(entity, Extra{});
            crowd.commands().remove<Speed>(entity);
            crowd.commands().add(entity, Badge{});
            crowd.commands().set(entity, Point{1, 2, 3});
            crowd.commands().remove<Extra>(entity);
            if (i % 3 == 0) {
                crowd.commands().destroy(entity);
            }
        }
    });
    check_flush("flush: all commands for one entity", [](Crowd& crowd) {
        for (std::size_t i = 0; i < crowd.entities.size(); ++i) {
            crowd.commands().add(crowd.entities[0], Cargo(static_cast<int>(i)));
        }
    });
    check_growth(
        "flush: add, observed",
        [](Crowd& crowd) {
            crowd.world.on_add<Extra>([](World&, std::span<const Entity>) {});
            crowd.world.on_add<Badge>([](World&, std::span<const Entity>) {});
            for (const Entity entity : crowd.shuffled) {
                crowd.commands().add(entity, Extra{});
            }
        },
        [](Crowd& crowd) { crowd.flush(); });
    check_growth("record in tasks and flush", [](Crowd& crowd) {
        crowd.world.run([](Query<const Point> points, Commands commands) {
            points.par_each([&](Entity entity, const Point&) {
                commands.add(entity, Extra{});
                commands.create(Cargo(1));
            });
        });
    });
}

TEST_CASE("complexity: a sync point moves every value at most twice, whatever the commands") {
    const OneThread one;
    Crowd crowd(5000);
    const auto moves_of = [&](const auto& record) {
        for (const Entity entity : crowd.shuffled) {
            record(entity);
        }
        Cargo::moves = 0;
        crowd.flush();
        return Cargo::moves;
    };
    const auto there = [&](Entity entity) {
        crowd.commands().add(entity, Extra{});
        crowd.commands().remove<Speed>(entity);
        crowd.commands().add(entity, Badge{});
        crowd.commands().remove<Point>(entity);
    };
    const auto back = [&](Entity entity) {
        crowd.commands().add(entity, Point{});
        crowd.commands().remove<Badge>(entity);
        crowd.commands().remove<Extra>(entity);
        crowd.commands().add(entity, Speed{});
    };
    moves_of(there);  // makes room, for which values may move too
    // To the new row, and before that perhaps into a hole.
    CHECK(moves_of(back) <= 2 * crowd.entities.size());
    CHECK(moves_of(there) <= 2 * crowd.entities.size());
}

TEST_CASE("complexity: snapshots are linear in the size of the world") {
    const OneThread one;
    const auto warm_every_second = [](Crowd& crowd) {
        for (std::size_t i = 0; i < crowd.shuffled.size(); i += 2) {
            crowd.world.add(crowd.shuffled[i], Warmth{1});
        }
    };
    check_growth("save_snapshot", warm_every_second, [](Crowd& crowd) {
        REQUIRE(save_snapshot(crowd.world).ok());
    });
    std::vector<std::byte> bytes;
    check_growth(
        "restore_snapshot",
        [&](Crowd& crowd) {
            warm_every_second(crowd);
            bytes = *save_snapshot(crowd.world);
        },
        [&](Crowd& crowd) { REQUIRE(restore_snapshot(crowd.world, bytes).ok()); });
    check_growth("state_hash", warm_every_second, [](Crowd& crowd) {
        static_cast<void>(state_hash(crowd.world));
    });
}

TEST_CASE("complexity: prefabs and trees are linear in the number of their entities") {
    const OneThread one;
    Prefab prefab;
    check_growth(
        "spawn many small prefabs",
        [&](Crowd& crowd) {
            crowd.world.add(crowd.entities[1], Parent{crowd.entities[0]});
            crowd.world.add(crowd.entities[2], Parent{crowd.entities[1]});
            crowd.world.add(crowd.entities[2], Friend{crowd.entities[0]});
            prefab = make_prefab(crowd.world, crowd.entities[0]);
        },
        [&](Crowd& crowd) { spawn(crowd.world, prefab, crowd.entities.size()); });
    for (const bool is_deep : {false, true}) {
        const auto tree = [is_deep](Crowd& crowd) { make_tree(crowd, is_deep); };
        const std::string kind = is_deep ? ", deep" : ", wide";
        check_growth("hierarchy" + kind, tree, [](Crowd& crowd) {
            static_cast<void>(hierarchy(crowd.world));
        });
        check_growth("make_prefab" + kind, tree, [](Crowd& crowd) {
            static_cast<void>(make_prefab(crowd.world, crowd.entities[0]));
        });
        check_growth(
            "spawn one large prefab" + kind,
            [&](Crowd& crowd) {
                tree(crowd);
                prefab = make_prefab(crowd.world, crowd.entities[0]);
            },
            [&](Crowd& crowd) { spawn(crowd.world, prefab); });
        check_growth("destroy_tree" + kind, tree, [](Crowd& crowd) {
            destroy_tree(crowd.world, crowd.entities[0]);
        });
    }
    check_growth("set_parent, wide", [](Crowd& crowd) {
        for (std::size_t i = 1; i < crowd.entities.size(); ++i) {
            static_cast<void>(set_parent(crowd.world, crowd.entities[i], crowd.entities[0]));
        }
    });
}

TEST_CASE("complexity: a query finds new archetypes without checking old ones again") {
    const OneThread one;
    const auto make_archetypes = [](Crowd& crowd) {
        const auto query = crowd.world.query<const Point, Without<Extra>>();
        for (std::size_t i = 0; i < crowd.entities.size(); ++i) {
            const Entity entity = crowd.entities[i];
            const auto flag = [&]<int number>() {
                if ((i >> number & 1) != 0) {
                    crowd.world.add<Flag<number>>(entity);
                }
            };
            [&]<int... numbers>(std::integer_sequence<int, numbers...>) {
                (flag.template operator()<numbers>(), ...);
            }
            (std::make_integer_sequence<int, 11>{});
            REQUIRE(query.contains(entity));
        }
    };
    check_growth(
        "n archetypes", [](Crowd&) {}, make_archetypes, 800);
}

TEST_CASE("complexity: iterating allocates nothing") {
    const OneThread one;
    Crowd crowd(3000);
    crowd.world.add(crowd.entities[5], Warmth{1});
    const auto iterate = [&] {
        crowd.world.query<Point, const Speed>().each([](Point& a, const Speed& b) { a.x += b.x; });
        crowd.world.query<const Point, Optional<const Speed>>().chunks(
            [](ChunkView, std::span<const Point>, std::span<const Speed>) {});
        crowd.world.query<const Warmth, const Point>().each([](const Warmth&, const Point&) {});
        crowd.world.query<const Point, Changed<Point>>().each([](const Point&) {});
        static_cast<void>(crowd.world.query<const Point, Without<Badge>>().count());
        static_cast<void>(crowd.world.query<const Point>().find<const Point>(crowd.entities[7]));
    };
    iterate();  // finds the archetypes
    CHECK(work_of(iterate).allocations == 0);
}

TEST_CASE(
    "complexity: creating, changing and destroying allocate nothing once memory is reserved") {
    const OneThread one;
    Crowd crowd(3000);
    const auto round = [&] {
        for (int i = 0; i < 2000; ++i) {
            const Entity entity = crowd.world.create(Point{}, Cargo(1), Warmth{});
            crowd.world.add(entity, Extra{});
            crowd.world.remove<Point>(entity);
            crowd.world.remove<Warmth>(entity);
            crowd.world.destroy(entity);
        }
    };
    round();
    CHECK(work_of(round).allocations == 0);
}

TEST_CASE("complexity: recording and applying commands allocate nothing once memory is reserved") {
    const OneThread one;
    Crowd crowd(3000);
    std::vector<Entity> created;
    const auto record = [&](int round) {
        for (const Entity entity : crowd.shuffled) {
            if (round % 2 == 0) {
                crowd.commands().add(entity, Extra{});
                crowd.commands().remove<Speed>(entity);
            } else {
                crowd.commands().remove<Extra>(entity);
                crowd.commands().add(entity, Speed{});
            }
            crowd.commands().set(entity, Cargo(round));
            crowd.commands().add(entity, Warmth{round});
            crowd.commands().destroy(crowd.commands().create(Point{}));
        }
    };
    Work recording;
    Work applying;
    for (int round = 0; round < 6; ++round) {
        recording = work_of([&] { record(round); });
        applying = work_of([&] { crowd.flush(); });
    }
    CHECK(recording.allocations == 0);
    CHECK(applying.allocations == 0);
}
