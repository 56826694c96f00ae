#pragma once

#include "bench/micro/ecs_measure.h"
#include "ecs/commands.h"
#include "ecs/system.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

// Creating and destroying entities, adding and removing components. Every repeat has its own world,
// in order of creation; the destination of moved rows is memory already touched. The functions
// named time_ return the time of all `count` entities together [ns].

namespace limn::bench {

// ---- without ECS

/// Lower bound of creating: fresh memory, a handle and three components per row.
inline double time_raw_fill(std::size_t count) {
    std::unique_ptr<Payload> arrays;
    return time_of([&] {
        arrays = std::make_unique<Payload>(count);
        for (std::size_t i = 0; i < count; ++i) {
            arrays->column<Entity>()[i] = {static_cast<std::uint32_t>(i), 1};
            arrays->column<Position>()[i] = {static_cast<float>(i), 0, 0};
            arrays->column<Velocity>()[i] = {1, 2, 3};
            arrays->column<Rotation>()[i] = {0, 0, 0, 1};
        }
    });
}

/// Lower bound of moving rows to another archetype: copying the handle and the components.
class RawMove {
  public:
    explicit RawMove(std::size_t count) : from_(count), to_(count), extra_(count) { time(); }
    double time() const {
        const std::size_t count = from_.size();
        return time_of([&] {
            std::copy_n(from_.column<Entity>(), count, to_.column<Entity>());
            std::copy_n(from_.column<Position>(), count, to_.column<Position>());
            std::copy_n(from_.column<Velocity>(), count, to_.column<Velocity>());
            std::copy_n(from_.column<Rotation>(), count, to_.column<Rotation>());
            std::fill_n(extra_.column<Extra>(), count, Extra{});
            keep(extra_);
        });
    }

  private:
    Payload from_;
    Payload to_;
    RawArrays<Extra> extra_;
};

/// Lower bound of destroying: putting the index of every slot on a free list.
inline double time_raw_free(std::size_t count) {
    std::vector<std::uint32_t> slots(count);
    std::vector<std::uint32_t> free(count);
    return time_of([&] {
        std::size_t size = 0;
        for (const std::uint32_t slot : slots) {
            free[size++] = slot;
        }
        keep(free[0]);
    });
}

// ---- create

inline void create_one_by_one(World& world, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        world.create(
            Position{static_cast<float>(i), 0, 0}, Velocity{1, 2, 3}, Rotation{0, 0, 0, 1});
    }
}

inline void create_bulk(World& world, std::size_t count) {
    std::vector<Entity> entities(count);
    world.create_many(
        std::span<Entity>(entities), Position{1, 0, 0}, Velocity{1, 2, 3}, Rotation{});
    keep(entities[0]);
}

enum class Memory { Fresh, Used };

template <typename Make>
double time_create(Bench& bench, std::size_t count, const Make& make, Memory memory) {
    World world;
    if (memory == Memory::Used) {
        create_bulk(world, count);
        world.clear();
    }
    const double time = time_of([&] { make(world, count); });
    bench.check(world.query<const Position>().count() == count, "create");
    return time;
}

inline void create(Bench& bench) {
    const auto ecs = [&](auto make, Memory memory) {
        return
            [&bench, make, memory] { return per(time_create(bench, kMany, make, memory), kMany); };
    };
    const auto times = take_turns(
        bench.slow_repeats, [&] { return bench.time_reference(); },
        [&] { return per(time_raw_fill(kMany), kMany); }, ecs(create_bulk, Memory::Fresh),
        ecs(create_bulk, Memory::Used), ecs(create_one_by_one, Memory::Fresh),
        ecs(create_one_by_one, Memory::Used));
    const auto row = [&](int gate, const char* name, const Timing& time, double limit) {
        bench.add(
            {gate, name, kMany, "ns", time, times[1], times[0], Figure::OfReference, limit, ""});
    };
    row(8, "create, bulk", times[2], 13);
    row(0, "create, bulk, memory used before", times[3], 0);
    row(9, "create, one by one", times[4], 20);
    row(0, "create, one by one, memory used before", times[5], 0);
}

// ---- destroy

enum class Order { Creation, Random };

inline double time_destroy(Bench& bench, std::size_t count, Order order) {
    World world;
    std::vector<Entity> entities = world.create_many(count, Position{}, Velocity{}, Rotation{});
    if (order == Order::Random) {
        std::vector<Entity> mixed;
        mixed.reserve(count);
        for (const std::uint32_t i : shuffled(count)) {
            mixed.push_back(entities[i]);
        }
        entities.swap(mixed);
    }
    const double time = time_of([&] {
        for (const Entity entity : entities) {
            world.destroy(entity);
        }
    });
    bench.check(world.entity_count() == 0, "destroy");
    return time;
}

/// Destroys everything in one call.
template <typename Destroy>
double time_destroy_all(Bench& bench, std::size_t count, const Destroy& destroy_all) {
    World world;
    create_bulk(world, count);
    const double time = time_of([&] { destroy_all(world); });
    bench.check(world.entity_count() == 0, "destroy all");
    return time;
}

inline void record_destroy(Query<const Position> all, Commands commands) {
    all.each([&](Entity entity, const Position&) { commands.destroy(entity); });
}
inline void destroy_by_commands(World& world) {
    world.run(record_destroy);
}
inline void destroy_by_query(World& world) {
    world.destroy_all(world.query<const Position>());
}
inline void destroy_by_clear(World& world) {
    world.clear();
}

inline void destroy(Bench& bench) {
    const auto times = take_turns(
        bench.slow_repeats, [&] { return bench.time_reference(); },
        [&] { return per(time_raw_free(kMany), kMany); },
        [&] { return per(time_destroy(bench, kMany, Order::Creation), kMany); },
        [&] { return per(time_destroy(bench, kMany, Order::Random), kMany); },
        [&] { return per(time_destroy_all(bench, kMany, destroy_by_query), kMany); },
        [&] { return per(time_destroy_all(bench, kMany, destroy_by_commands), kMany); },
        [&] { return per(time_destroy_all(bench, kMany, destroy_by_clear), kMany); });
    const auto row = [&](int gate, const char* name, const Timing& time, double limit) {
        bench.add(
            {gate, name, kMany, "ns", time, times[1], times[0], Figure::OfReference, limit, ""});
    };
    row(10, "destroy, one by one, order of creation", times[2], 14);
    row(0, "destroy, one by one, random order", times[3], 0);
    row(10, "destroy, all of a query", times[4], 4);
    row(0, "destroy, all of a query by commands", times[5], 0);
    row(0, "destroy, World::clear", times[6], 0);
}

// ---- add and remove

/// For entities without Extra: changes nothing, but grows the world's sync point buffers to their
/// final size.
inline void remove_from_all(Query<const Position> all, Commands commands) {
    all.each([&](Entity entity, const Position&) { commands.remove<Extra>(entity); });
}

/// A world whose entities have 3 components, with memory for all of them plus Extra already
/// touched.
struct AddWorld {
    World world;
    std::vector<Entity> entities;

    explicit AddWorld(std::size_t count)
        : entities(fill<Position, Velocity, Rotation>(world, count)) {
        std::vector<Entity> others =
            world.create_many(count, Position{}, Velocity{}, Rotation{}, Extra{});
        while (!others.empty()) {
            world.destroy(others.back());
            others.pop_back();
        }
    }
    /// Touches the memory of the sparse set, too.
    void use_sparse_set() {
        for (const Entity entity : entities) {
            world.add(entity, SparseExtra{});
        }
        for (std::size_t i = entities.size(); i > 0; --i) {
            world.remove<SparseExtra>(entities[i - 1]);
        }
    }

    template <typename T>
    [[nodiscard]] bool all_have() const {
        for (const Entity entity : entities) {
            const T* found = world.find<T>(entity);
            if (found == nullptr || found->value[0] != static_cast<float>(entity.index)) {
                return false;
            }
        }
        return true;
    }
};

template <typename T>
T extra_of(Entity entity) {
    return {{static_cast<float>(entity.index), 1, 2, 3}};
}

struct AddTimes {
    double add = 0;
    double remove = 0;
};

template <typename T>
AddTimes time_add_and_remove(Bench& bench, std::size_t count) {
    AddWorld made(count);
    World& world = made.world;
    if constexpr (std::is_same_v<T, SparseExtra>) {
        made.use_sparse_set();
    }
    AddTimes times;
    times.add = time_of([&] {
        for (const Entity entity : made.entities) {
            world.add(entity, extra_of<T>(entity));
        }
    });
    bench.check(made.all_have<T>(), "add");
    times.remove = time_of([&] {
        for (const Entity entity : made.entities) {
            world.remove<T>(entity);
        }
    });
    bench.check(world.query<const Position, Without<T>>().count() == count, "remove");
    return times;
}

/// Only to a quarter of the entities, in random order.
inline double time_add_to_quarter(Bench& bench, std::size_t count) {
    AddWorld made(count);
    std::vector<Entity> chosen;
    for (const std::uint32_t i : shuffled(count)) {
        if (chosen.size() < count / 4) {
            chosen.push_back(made.entities[i]);
        }
    }
    const double time = time_of([&] {
        for (const Entity entity : chosen) {
            made.world.add(entity, extra_of<Extra>(entity));
        }
    });
    bench.check(made.world.query<const Extra>().count() == count / 4, "add to a quarter");
    return time;
}

enum class Target { Empty, Occupied };

/// To all in one call. If the target archetype is empty, whole columns are handed over; otherwise
/// they are copied.
inline AddTimes time_add_and_remove_all(Bench& bench, std::size_t count, Target target) {
    AddWorld made(count);
    World& world = made.world;
    std::size_t others = 0;
    if (target == Target::Occupied) {
        world.create(Position{}, Velocity{}, Rotation{}, Extra{});
        world.create(Position{}, Velocity{}, Rotation{});
        others = 1;
    }
    const auto without = world.query<const Position, Without<Extra>>();
    AddTimes times;
    times.add = time_of([&] { world.add_all(without, Extra{{7, 1, 2, 3}}); });
    bench.check(
        world.query<const Extra>().count() == count + 2 * others
            && world.get<const Extra>(made.entities[count / 2]).value[0] == 7,
        "add to all");
    if (target == Target::Occupied) {
        world.create(Position{}, Velocity{}, Rotation{});
    }
    times.remove = time_of([&] { world.remove_all<Extra>(world.query<const Extra>()); });
    bench.check(world.query<const Extra>().count() == 0, "remove from all");
    return times;
}

inline void add_and_remove(Bench& bench) {
    const RawMove copy(kMany);
    AddTimes table;
    AddTimes sparse;
    AddTimes empty;
    AddTimes occupied;
    const auto times = take_turns(
        bench.slow_repeats, [&] { return bench.time_reference(); },
        [&] { return per(copy.time(), kMany); },
        [&] {
            table = time_add_and_remove<Extra>(bench, kMany);
            return per(table.add, kMany);
        },
        [&] { return per(table.remove, kMany); },
        [&] {
            sparse = time_add_and_remove<SparseExtra>(bench, kMany);
            return per(sparse.add, kMany);
        },
        [&] { return per(sparse.remove, kMany); },
        [&] { return per(time_add_to_quarter(bench, kMany), kMany / 4); },
        [&] {
            empty = time_add_and_remove_all(bench, kMany, Target::Empty);
            return per(empty.add, kMany);
        },
        [&] { return per(empty.remove, kMany); },
        [&] {
            occupied = time_add_and_remove_all(bench, kMany, Target::Occupied);
            return per(occupied.add, kMany);
        },
        [&] { return per(occupied.remove, kMany); });
    const auto row = [&](int gate, const char* name, std::size_t count, const Timing& time,
                         double limit) {
        bench.add(
            {gate, name, count, "ns", time, times[1], times[0], Figure::OfReference, limit, ""});
    };
    row(11, "add, table, one by one", kMany, times[2], 33);
    row(11, "remove, table, one by one", kMany, times[3], 33);
    row(12, "add, sparse, one by one", kMany, times[4], 15);
    row(12, "remove, sparse, one by one", kMany, times[5], 15);
    row(0, "add, table, to a random quarter, one by one", kMany / 4, times[6], 0);
    row(0, "add, all of a query", kMany, times[7], 0);
    row(0, "remove, all of a query", kMany, times[8], 0);
    row(0, "add, all of a query, to an archetype in use", kMany, times[9], 0);
    row(0, "remove, all of a query, to an archetype in use", kMany, times[10], 0);
}

// ---- deferred

inline void add_to_all(Query<const Position, Without<Extra>> all, Commands commands) {
    all.each(
        [&](Entity entity, const Position&) { commands.add(entity, extra_of<Extra>(entity)); });
}

struct Chosen {
    std::vector<Entity> entities;
};

inline void add_to_chosen(Res<const Chosen> chosen, Commands commands) {
    for (const Entity entity : chosen->entities) {
        commands.add(entity, extra_of<Extra>(entity));
    }
}

inline void remove_from_chosen(Res<const Chosen> chosen, Commands commands) {
    for (const Entity entity : chosen->entities) {
        commands.remove<Extra>(entity);
    }
}

struct DeferredTime {
    double record = 0;
    double flush = 0;
    [[nodiscard]] double both() const { return record + flush; }
};

inline DeferredTime run_deferred(World& world, System& system) {
    DeferredTime time;
    const std::uint32_t version = world.begin_run();
    system.prepare(world);
    time.record = time_of([&] { system.run(world, version); });
    CommandBuffer* commands = system.commands();
    time.flush = time_of([&] { apply_commands(world, {&commands, 1}); });
    return time;
}

/// Systems that record commands and keep their buffers between runs, as a schedule's do.
class Deferred {
  public:
    /// Adds Extra to all entities.
    DeferredTime time_all(Bench& bench, std::size_t count) {
        AddWorld made(count);
        made.world.run(remove_from_all);
        const DeferredTime time = run_deferred(made.world, all_);
        bench.check(made.all_have<Extra>(), "deferred add");
        return time;
    }
    /// Adds Extra to a random quarter.
    DeferredTime time_quarter(Bench& bench, std::size_t count) {
        AddWorld made(count);
        Chosen list;
        for (const std::uint32_t i : shuffled(count)) {
            if (list.entities.size() < count / 4) {
                list.entities.push_back(made.entities[i]);
            }
        }
        made.world.insert_resource(list);
        made.world.run(remove_from_chosen);
        const DeferredTime time = run_deferred(made.world, chosen_);
        bench.check(
            made.world.query<const Extra>().count() == count / 4
                && made.world.get<const Extra>(list.entities[7]).value[0]
                       == static_cast<float>(list.entities[7].index),
            "random quarter");
        return time;
    }

  private:
    System all_ = make_system<add_to_all>();
    System chosen_ = make_system<add_to_chosen>();
};

inline void deferred(Bench& bench) {
    constexpr std::size_t kQuarter = kMany / 4;
    const RawMove copy(kMany);
    Deferred systems;
    systems.time_all(bench, kMany);  // the buffers grow to their size
    DeferredTime all;
    DeferredTime chosen;
    const auto times = take_turns(
        bench.slow_repeats, [&] { return bench.time_reference(); },
        [&] { return per(copy.time(), kMany); },
        [&] {
            all = systems.time_all(bench, kMany);
            return per(all.both(), kMany);
        },
        [&] { return per(all.record, kMany); }, [&] { return per(all.flush, kMany); },
        [&] {
            chosen = systems.time_quarter(bench, kMany);
            return per(chosen.both(), kQuarter);
        },
        [&] { return per(chosen.record, kQuarter); }, [&] { return per(chosen.flush, kQuarter); });
    const auto row = [&](int gate, const char* name, std::size_t count, const Timing& time,
                         double limit) {
        bench.add(
            {gate, name, count, "ns", time, times[1], times[0], Figure::OfReference, limit, ""});
    };
    row(14, "deferred add to all", kMany, times[2], 22);
    row(0, "    of it recording", kMany, times[3], 0);
    row(0, "    of it the sync point", kMany, times[4], 0);
    row(15, "deferred add to a random quarter", kQuarter, times[5], 80);
    row(0, "    of it recording", kQuarter, times[6], 0);
    row(0, "    of it the sync point", kQuarter, times[7], 0);
}

}  // namespace limn::bench
