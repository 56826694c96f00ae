#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/hierarchy.h"
#include "ecs/prefab.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

// One history for any number of threads and any order in which tasks happen to start: a scene in
// which everything happens that could go wrong. Systems conflict, record creations in tasks, move
// along links, follow sparse components, ask for changes, draw random numbers and change the
// structure alone.

namespace determinism_test {

using namespace limn;

struct Spot {
    Vec3 position = {0, 0, 0};
};
struct Drift {
    Vec3 speed = {0, 0, 0};
};
struct Age {
    std::uint32_t frames = 0;
};
/// Where it is with all its parents added.
struct Point {
    Vec3 position = {0, 0, 0};
};
struct Excited {};
/// Sparse.
struct Glow {
    float light = 0;
};

}  // namespace determinism_test

template <>
struct limn::ComponentTraits<determinism_test::Glow> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

namespace determinism_test {

/// Who came just before it, in the same task.
struct Elder {
    Entity entity;
};

/// One of a kind.
struct Totals {
    float light = 0;
    std::uint32_t moved = 0;
    std::uint32_t aged = 0;
    std::uint64_t order = 0;  ///< of the entities that were told to observers
};

template <typename Visitor>
void visit_fields(Elder& elder, Visitor&& visit) {
    visit("entity", elder.entity, {.doc = "may be gone"});
}
template <typename Visitor>
void visit_fields(Totals& totals, Visitor&& visit) {
    visit("light", totals.light, {.doc = "of all that glows"});
    visit("moved", totals.moved, {.doc = "in chunks that moved"});
    visit("aged", totals.aged, {.doc = "in chunks that aged"});
    visit("order", totals.order, {.doc = "of what came and went"});
}

/// What the systems read of the frame.
struct Frame {
    std::uint32_t number = 0;
};

Random random_of(Entity entity, std::uint32_t system, const Frame& frame) {
    return Random(20'261, entity.bits(), system, frame.number);
}

void drift(Query<Drift, const Spot> drifting, Res<const Frame> frame) {
    drifting.par_each([&](Entity entity, Drift& drift, const Spot& spot) {
        Random random = random_of(entity, name_hash("drift"), *frame);
        drift.speed += 0.1f * random.direction() - 0.01f * spot.position;
    });
}

void move(Query<Spot, const Drift> moving) {
    moving.par_chunks([](ChunkView, std::span<Spot> spots, std::span<const Drift> drifts) {
        for (std::size_t i = 0; i < spots.size(); ++i) {
            spots[i].position += drifts[i].speed;
        }
    });
}

/// Ages two chunks out of three.
void grow_old(Query<Age> ages, Res<const Frame> frame) {
    ages.par_chunks([&](ChunkView chunk, std::span<Age> span) {
        if ((chunk.index() + frame->number) % 3 == 0) {
            chunk.mark_unchanged<Age>();
            return;
        }
        for (Age& age : span) {
            ++age.frames;
        }
    });
}

/// Two children with every birth: the second knows the first.
void give_birth(Query<const Spot, const Age> parents, Res<const Frame> frame, Commands commands) {
    parents.par_chunks(
        [&](ChunkView chunk, std::span<const Spot> spots, std::span<const Age> ages) {
            for (std::size_t i = 0; i < spots.size(); ++i) {
                const Entity entity = chunk.entities()[i];
                Random random = random_of(entity, name_hash("give_birth"), *frame);
                if (ages[i].frames < 3 || random.below(60) != 0) {
                    continue;
                }
                const Entity first = commands.create(
                    Spot{0.5f * spots[i].position}, Age{}, Parent{entity, random.below(3)});
                const Entity second = commands.create(Elder{first}, Spot{}, Drift{}, Age{});
                commands.add(second, Point{});
                commands.add(first, Elder{second});
                if (random.below(4) == 0) {
                    commands.destroy(first);
                }
            }
        });
}

void die(Query<const Age, Optional<const Parent>> all, Res<const Frame> frame, Commands commands) {
    all.par_each([&](Entity entity, const Age& age, const Parent* parent) {
        Random random = random_of(entity, name_hash("die"), *frame);
        if (random.below(30 + (parent != nullptr ? 10 : 0)) < age.frames / 16) {
            commands.destroy(entity);
            commands.add(entity, Glow{1});  // too late
        }
    });
}

void kindle(Query<const Spot, Without<Glow>> dark, Res<const Frame> frame, Commands commands) {
    dark.par_each([&](Entity entity, const Spot&) {
        Random random = random_of(entity, name_hash("kindle"), *frame);
        if (random.below(20) == 0) {
            commands.add(entity, Glow{random.uniform(1, 2)});
        }
    });
}

void burn_down(Query<Glow> glowing, Commands commands) {
    glowing.par_each([&](Entity entity, Glow& glow) {
        glow.light -= 0.13f;
        if (glow.light < 0) {
            commands.remove<Glow>(entity);
        }
    });
}

/// Everybody orders everybody about: commands of several systems and tasks for one entity.
void excite(
    Query<const Spot, Optional<const Elder>> all, Res<const Frame> frame, Commands commands) {
    all.par_each([&](Entity entity, const Spot& spot, const Elder* elder) {
        Random random = random_of(entity, name_hash("excite"), *frame);
        const std::uint32_t choice = random.below(24);
        if (choice == 0) {
            commands.add<Excited>(entity);
        } else if (choice == 1) {
            commands.remove<Excited>(entity);
        } else if (choice == 2) {
            commands.set(entity, Spot{-spot.position});
        } else if (choice < 5 && elder != nullptr) {
            commands.add(elder->entity, Drift{spot.position});  // the last one wins
        } else if (choice == 5 && elder != nullptr) {
            commands.remove<Drift>(elder->entity);
        }
    });
}

void place(HierarchyRef hierarchy, Query<const Spot> spots, Query<Point> points) {
    spots.each([&](Entity entity, const Spot& spot) {
        if (Point* const point = points.find<Point>(entity)) {
            point->position = spot.position;
        }
    });
    for (std::uint32_t depth = 1; depth <= hierarchy->depth_count(); ++depth) {
        const std::span<const HierarchyNode> nodes = hierarchy->level(depth);
        parallel_for(nodes.size(), 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Spot* const above = spots.find<const Spot>(nodes[i].parent);
                Point* const point = points.find<Point>(nodes[i].entity);
                if (above != nullptr && point != nullptr) {
                    point->position += above->position;
                }
            }
        });
    }
}

void add_up(
    Query<const Glow> glowing, Query<const Spot, Changed<Spot>> moved,
    Query<const Age, Changed<Age>> aged, Res<Totals> totals) {
    std::vector<float> partial(moved.chunk_count());
    moved.par_chunks([&](ChunkView chunk, std::span<const Spot> spots) {
        for (const Spot& spot : spots) {
            partial[chunk.index()] += spot.position.x;
        }
    });
    for (const float sum : partial) {
        totals->light += sum;
    }
    glowing.each([&](const Glow& glow) { totals->light += glow.light; });
    totals->moved += static_cast<std::uint32_t>(moved.count());
    totals->aged += static_cast<std::uint32_t>(aged.count());
}

/// Alone: the structure changes at once.
void rearrange(World& world) {
    std::vector<Entity> all;
    world.each_entity([&](Entity entity) { all.push_back(entity); });
    const Frame frame = std::as_const(world).resource<Frame>();
    Random random(20'261, frame.number, name_hash("rearrange"), 0);
    const auto any = [&] { return all[random.below(static_cast<std::uint32_t>(all.size()))]; };
    for (int i = 0; i < 12; ++i) {
        static_cast<void>(set_parent(world, any(), any()));
    }
    if (frame.number % 8 == 5) {
        const Entity root = any();
        const Prefab prefab = make_prefab(world, root);
        if (prefab.entities.size() < 40) {
            spawn(world, prefab, 2);
        }
        destroy_tree(world, root);
    }
}

Schedule make_schedule() {
    Schedule schedule;
    schedule.set_always_parallel(true);
    schedule.add<drift>().add<grow_old>().add<burn_down>().add<kindle>().add<give_birth>();
    schedule.add<move>().add<excite>().add<die>().add<add_up>();
    schedule.sync();
    schedule.add<place>().add<add_up>().add<rearrange>();
    return schedule;
}

}  // namespace determinism_test

using namespace limn;
using namespace determinism_test;

namespace {

#if defined(LIMN_SANITIZED)
constexpr std::uint32_t kFrames = 20;
#else
constexpr std::uint32_t kFrames = 60;
#endif

struct JobsGuard {
    int before = thread_count();
    ~JobsGuard() {
        set_thread_count(before);
        set_task_shuffle(0);
    }
};

template <typename T>
void note_order(World& world) {
    const auto note = [](World& told, std::span<const Entity> entities) {
        Totals& totals = told.resource<Totals>();
        for (const Entity entity : entities) {
            totals.order = hash_combine(totals.order, entity.bits());
        }
    };
    world.on_add<T>(note);
    world.on_remove<T>(note);
}

/// The hash after every frame.
std::vector<std::uint64_t> history(int threads, std::uint64_t shuffle) {
    register_component<Elder>();
    register_resource<Totals>();
    set_thread_count(threads);
    set_task_shuffle(shuffle);
    World world;
    world.insert_resource(Frame{});
    world.insert_resource(Totals{});
    world.insert_resource(Hierarchy{});
    note_order<Glow>(world);
    note_order<Drift>(world);
    for (int i = 0; i < 3000; ++i) {
        const Spot spot{{static_cast<float>(i), 1, 0}};
        i % 2 == 0 ? world.create(spot, Drift{}, Age{static_cast<std::uint32_t>(i % 7)}, Point{})
                   : world.create(spot, Drift{}, Age{});
    }
    Schedule schedule = make_schedule();
    std::vector<std::uint64_t> hashes;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
        world.resource<Frame>().number = frame;
        schedule.run(world);
        hashes.push_back(state_hash(world));
    }
    CHECK(world.entity_count() > 3000);
    CHECK(std::as_const(world).resource<Totals>().moved > 0);
    return hashes;
}

}  // namespace

TEST_CASE("determinism: the same history for 1 to 64 threads and any order of tasks") {
    const JobsGuard guard;
    const std::vector<std::uint64_t> expected = history(1, 0);
    CHECK(expected.front() != expected.back());
    int runs = 1;
    for (const int threads : {1, 2, 3, 7, 16, 64}) {
        for (std::uint64_t shuffle = 0; shuffle < 5; ++shuffle, ++runs) {
            CAPTURE(threads);
            CAPTURE(shuffle);
            REQUIRE(history(threads, shuffle) == expected);
        }
    }
    std::printf("determinism: %d histories of %u frames\n", runs, kFrames);
}
