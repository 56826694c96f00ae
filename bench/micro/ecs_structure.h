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

// Entities that come, go and change their components. Every repeat has a world of its own, in the
// order of creation; where rows move to, memory has been used before.

namespace limn::bench {

// ---- create and destroy
// -------------------------------------------------------------------------

/// 40 bytes, 3 components.
using Payload = RawArrays<Entity, Position, Velocity, Rotation>;

inline void create_all(World& world) {
    for (std::size_t i = 0; i < kMany; ++i) {
        world.create(
            Position{static_cast<float>(i), 0, 0}, Velocity{1, 2, 3}, Rotation{0, 0, 0, 1});
    }
}

inline void create_bulk(World& world) {
    std::vector<Entity> entities(kMany);
    world.create_many(
        std::span<Entity>(entities), Position{1, 0, 0}, Velocity{1, 2, 3}, Rotation{});
    keep(entities[0]);
}

inline void create(Bench& bench) {
    const auto check_all = [&](const World& world) {
        bench.check(world.query<const Position>().count() == kMany, "create");
    };
    const auto in_new_world = [&](auto&& make) {
        World world;
        const double time = time_of([&] { make(world); });
        check_all(world);
        return per(time, kMany);
    };
    const auto in_used_world = [&](auto&& make) {
        World world;
        create_bulk(world);
        world.clear();
        const double time = time_of([&] { make(world); });
        check_all(world);
        return per(time, kMany);
    };
    // What any ECS has to do: fresh memory, a handle and three components a row.
    const auto fill_raw = [] {
        std::unique_ptr<Payload> arrays;
        const double time = time_of([&] {
            arrays = std::make_unique<Payload>(kMany);
            for (std::size_t i = 0; i < kMany; ++i) {
                arrays->column<Entity>()[i] = {static_cast<std::uint32_t>(i), 1};
                arrays->column<Position>()[i] = {static_cast<float>(i), 0, 0};
                arrays->column<Velocity>()[i] = {1, 2, 3};
                arrays->column<Rotation>()[i] = {0, 0, 0, 1};
            }
        });
        return per(time, kMany);
    };
    const auto times = take_turns(
        bench.slow_repeats,
        [&] { return bench.time_reference(); },
        fill_raw,
        [&] { return in_new_world(create_bulk); },
        [&] { return in_used_world(create_bulk); },
        [&] { return in_new_world(create_all); },
        [&] { return in_used_world(create_all); });
    const auto row = [&](int gate, const char* name, const Timing& time, double limit) {
        bench.add({gate, name, kMany, "ns", time, times[1], times[0], Figure::OfReference, limit});
    };
    row(8, "create, bulk", times[2], 13);
    row(0, "create, bulk, memory used before", times[3], 0);
    row(9, "create, one by one", times[4], 20);
    row(0, "create, one by one, memory used before", times[5], 0);
}

inline void destroy_all(Query<const Position> all, Commands commands) {
    all.each([&](Entity entity, const Position&) { commands.destroy(entity); });
}

inline void destroy(Bench& bench) {
    const auto one_by_one = [&](bool shuffle) {
        World world;
        std::vector<Entity> entities = world.create_many(kMany, Position{}, Velocity{}, Rotation{});
        if (shuffle) {
            std::vector<Entity> mixed;
            for (const std::uint32_t i : shuffled(kMany)) {
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
        return per(time, kMany);
    };
    const auto by_query = [&] {
        World world;
        create_bulk(world);
        const double time = time_of([&] { world.run(destroy_all); });
        bench.check(world.entity_count() == 0, "destroy by commands");
        return per(time, kMany);
    };
    const auto by_clear = [&] {
        World world;
        create_bulk(world);
        const double time = time_of([&] { world.clear(); });
        bench.check(world.entity_count() == 0, "clear");
        return per(time, kMany);
    };
    const auto times = take_turns(
        bench.slow_repeats,
        [&] { return bench.time_reference(); },
        [&] { return one_by_one(false); },
        [&] { return one_by_one(true); },
        by_query,
        by_clear);
    const auto row = [&](int gate, const char* name, const Timing& time, double limit) {
        bench.add({gate, name, kMany, "ns", time, {}, times[0], Figure::OfReference, limit});
    };
    row(10, "destroy, one by one, order of creation", times[1], 14);
    row(0, "destroy, one by one, random order", times[2], 0);
    row(10, "destroy, by query and commands", times[3], 4);
    row(0, "destroy, World::clear", times[4], 0);
}

// ---- add and remove
// -----------------------------------------------------------------------------

/// A world whose entities have 3 components, and memory for all of them with Extra, touched.
struct AddWorld {
    World world;
    std::vector<Entity> entities;

    AddWorld() : entities(fill<Position, Velocity, Rotation>(world, kMany)) {
        std::vector<Entity> others =
            world.create_many(kMany, Position{}, Velocity{}, Rotation{}, Extra{});
        while (!others.empty()) {
            world.destroy(others.back());
            others.pop_back();
        }
        for (const Entity entity : entities) {
            world.add(entity, SparseExtra{});
        }
        for (std::size_t i = kMany; i > 0; --i) {
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

/// Makes the world's lists for sync points as long as they get.
inline void remove_from_all(Query<const Position> all, Commands commands) {
    all.each([&](Entity entity, const Position&) { commands.remove<Extra>(entity); });
}

template <typename T>
T extra_of(Entity entity) {
    return {{static_cast<float>(entity.index), 1, 2, 3}};
}

template <typename T>
std::pair<double, double> time_add_and_remove(Bench& bench) {
    AddWorld made;
    World& world = made.world;
    const double add = time_of([&] {
        for (const Entity entity : made.entities) {
            world.add(entity, extra_of<T>(entity));
        }
    });
    bench.check(made.all_have<T>(), "add");
    const double remove = time_of([&] {
        for (const Entity entity : made.entities) {
            world.remove<T>(entity);
        }
    });
    bench.check(world.query<const Position, Without<T>>().count() == kMany, "remove");
    return {per(add, kMany), per(remove, kMany)};
}

inline void add_and_remove(Bench& bench) {
    // What moving a row to another archetype has to do: copy the handle and the components.
    const Payload from(kMany);
    const Payload to(kMany);
    const RawArrays<Extra> extra(kMany);
    const auto copy = [&] {
        return per(
            time_of([&] {
                std::copy_n(from.column<Entity>(), kMany, to.column<Entity>());
                std::copy_n(from.column<Position>(), kMany, to.column<Position>());
                std::copy_n(from.column<Velocity>(), kMany, to.column<Velocity>());
                std::copy_n(from.column<Rotation>(), kMany, to.column<Rotation>());
                std::fill_n(extra.column<Extra>(), kMany, Extra{});
                keep(extra);
            }),
            kMany);
    };
    double remove_table = 0;
    double remove_sparse = 0;
    const auto times = take_turns(
        bench.slow_repeats,
        [&] { return bench.time_reference(); },
        copy,
        [&] {
            const auto [add, remove] = time_add_and_remove<Extra>(bench);
            remove_table = remove;
            return add;
        },
        [&] { return remove_table; },
        [&] {
            const auto [add, remove] = time_add_and_remove<SparseExtra>(bench);
            remove_sparse = remove;
            return add;
        },
        [&] { return remove_sparse; });
    const auto row = [&](int gate, const char* name, const Timing& time, double limit) {
        bench.add({gate, name, kMany, "ns", time, times[1], times[0], Figure::OfReference, limit});
    };
    row(11, "add, table, one by one", times[2], 33);
    row(11, "remove, table, one by one", times[3], 33);
    row(12, "add, sparse, one by one", times[4], 15);
    row(12, "remove, sparse, one by one", times[5], 15);
}

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

struct DeferredTime {
    double record = 0;
    double flush = 0;
};

inline DeferredTime time_deferred(World& world, System& system) {
    DeferredTime time;
    const std::uint32_t version = world.begin_run();
    system.prepare(world);
    time.record = time_of([&] { system.run(world, version); });
    CommandBuffer* commands = system.commands();
    time.flush = time_of([&] { apply_commands(world, {&commands, 1}); });
    return time;
}

inline void deferred(Bench& bench) {
    System all = make_system<add_to_all>();
    System chosen = make_system<add_to_chosen>();
    const std::vector<std::uint32_t> order = shuffled(kMany);
    constexpr std::size_t kQuarter = kMany / 4;
    DeferredTime all_time;
    DeferredTime chosen_time;
    const auto run_all = [&] {
        AddWorld made;
        made.world.run(remove_from_all);
        all_time = time_deferred(made.world, all);
        bench.check(made.all_have<Extra>(), "deferred add");
        return per(all_time.record + all_time.flush, kMany);
    };
    const auto run_chosen = [&] {
        AddWorld made;
        made.world.run(remove_from_all);
        Chosen list;
        for (std::size_t i = 0; i < kQuarter; ++i) {
            list.entities.push_back(made.entities[order[i]]);
        }
        made.world.insert_resource(list);
        chosen_time = time_deferred(made.world, chosen);
        bench.check(
            made.world.query<const Extra>().count() == kQuarter
                && made.world.get<const Extra>(list.entities[7]).value[0]
                       == static_cast<float>(list.entities[7].index),
            "random quarter");
        return per(chosen_time.record + chosen_time.flush, kQuarter);
    };
    run_all();  // the buffers of the systems grow to their size
    const auto times = take_turns(
        bench.slow_repeats,
        [&] { return bench.time_reference(); },
        run_all,
        [&] { return per(all_time.record, kMany); },
        [&] { return per(all_time.flush, kMany); },
        run_chosen,
        [&] { return per(chosen_time.record, kQuarter); },
        [&] { return per(chosen_time.flush, kQuarter); });
    const auto row =
        [&](int gate, const char* name, std::size_t count, const Timing& time, double limit) {
            bench.add({gate, name, count, "ns", time, {}, times[0], Figure::OfReference, limit});
        };
    row(14, "deferred add to all", kMany, times[1], 22);
    row(0, "    of it recording", kMany, times[2], 0);
    row(0, "    of it the sync point", kMany, times[3], 0);
    row(15, "deferred add to a random quarter", kQuarter, times[4], 80);
    row(0, "    of it recording", kQuarter, times[5], 0);
    row(0, "    of it the sync point", kQuarter, times[6], 0);
}

}  // namespace limn::bench
