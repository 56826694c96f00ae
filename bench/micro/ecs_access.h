#pragma once

#include "bench/micro/ecs_measure.h"
#include "ecs/base/hash.h"
#include "ecs/snapshot.h"
#include "ecs/world_stats.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

// Random access to entities, memory use, change detection, and copies of a world.

namespace limn::bench {

inline void random_get(Bench& bench, std::size_t count, double limit) {
    World world;
    const std::vector<Entity> entities = fill<Position, Velocity, Rotation>(world, count);
    const RawArrays<Position> arrays(count);
    arrays.start_all();
    const std::vector<std::uint32_t> order = shuffled(count);
    std::vector<Entity> mixed;
    for (const std::uint32_t i : order) {
        mixed.push_back(entities[i]);
    }
    float raw_sum = 0;
    float ecs_sum = 0;
    const auto get_raw = [&] {
        const Position* positions = arrays.column<Position>();
        raw_sum = 0;
        for (const std::uint32_t i : order) {
            raw_sum += positions[i].x;
        }
    };
    const World& readable = world;
    const auto get_ecs = [&] {
        ecs_sum = 0;
        for (const Entity entity : mixed) {
            ecs_sum += readable.get<Position>(entity).x;
        }
    };
    float gathered_sum = 0;
    const auto query = world.query<const Position>();
    const auto gather = [&] {
        gathered_sum = 0;
        query.gather(mixed, [&](std::size_t, const Position& p) { gathered_sum += p.x; });
    };
    const auto timed = [&](auto&& once) {
        return per(time_of_rounds(rounds_for(count), once), count);
    };
    const auto times = take_turns(
        bench.repeats, [&] { return bench.time_reference(); }, [&] { return timed(get_raw); },
        [&] { return timed(get_ecs); }, [&] { return timed(gather); });
    bench.check(raw_sum == ecs_sum && raw_sum == gathered_sum, "random get");
    const auto row = [&](int gate, const char* name, const Timing& time, double gate_limit) {
        bench.add(
            {gate, name, count, "ns", time, times[1], times[0], Figure::OfReference, gate_limit,
             ""});
    };
    row(16, "random get", times[2], limit);
    // In the cache, prefetching gains nothing.
    const bool is_large = count > kCached;
    row(is_large ? 16 : 0, "random get, by gather", times[3], is_large ? limit : 0);
}

inline void memory(Bench& bench) {
    World world;
    fill<Position, Velocity, Rotation>(world, kMany);
    const double bytes = static_cast<double>(world.memory().total()) / static_cast<double>(kMany);
    bench.add(
        {17,
         "memory, 40 B payload",
         kMany,
         "B",
         {bytes, bytes},
         {40, 40},
         {},
         Figure::Plain,
         60,
         ""});
}

inline void changed(Bench& bench) {
    World world;
    const std::vector<Entity> entities = fill<Position, Velocity>(world, kMany);
    const RawArrays<Position> arrays(kMany);
    const std::uint32_t version = world.version();
    std::size_t visited = 0;
    const auto query = world.query<const Position, Changed<Position>>();
    const auto query_changes = [&] {
        return time_of_rounds(1000, [&] {
            query.since(version).each([&](const Position&) { ++visited; });
            keep(visited);
        });
    };
    const auto read_raw = [&] {
        return time_of([&] {
            float sum = 0;
            for (std::size_t i = 0; i < kMany; ++i) {
                sum += arrays.column<Position>()[i].x;
            }
            keep(sum);
        });
    };
    const auto times = take_turns(bench.repeats, read_raw, query_changes);
    bench.check(visited == 0, "nothing changed");
    world.get<Position>(entities[5000]).x = 1;
    query.since(version).each([&](const Position&) { ++visited; });
    bench.check(visited == 1024, "one chunk changed");
    bench.add(
        {23,
         "changed since, nothing changed",
         kMany,
         "ns/call",
         times[1],
         times[0],
         {},
         Figure::Plain,
         2000,
         ""});
}

// ---- copies of a world

/// Copies the bytes of a snapshot to new memory, as saving does.
inline double time_raw_copy(std::span<const std::byte> bytes) {
    return time_of([&] {
        const std::vector<std::byte> copy(bytes.begin(), bytes.end());
        keep(copy[0]);
    });
}

struct SnapshotTimes {
    double save = 0;
    double restore = 0;
    double copy = 0;
};

inline SnapshotTimes time_snapshot(Bench& bench, World& world) {
    SnapshotTimes times;
    const std::uint64_t before = state_hash(world);
    std::vector<std::byte> bytes;
    times.save = time_of([&] { bytes = *save_snapshot(world); });
    times.restore = time_of([&] { bench.check(restore_snapshot(world, bytes).ok(), "restore"); });
    times.copy = time_raw_copy(bytes);
    bench.check(state_hash(world) == before, "the restored world");
    return times;
}

inline void hash_time(Bench& bench) {
    World world;
    fill<Position, Velocity, Rotation>(world, kMany);
    const Payload arrays(kMany);
    const auto times = take_turns(
        bench.slow_repeats, [&] { return per(time_of([&] { keep(state_hash(world)); }), kMany); },
        [&] {
            return per(
                time_of([&] {
                    keep(hash_bytes(arrays.column<Entity>(), kMany * sizeof(Entity)));
                    keep(hash_bytes(arrays.column<Position>(), kMany * sizeof(Position)));
                    keep(hash_bytes(arrays.column<Velocity>(), kMany * sizeof(Velocity)));
                    keep(hash_bytes(arrays.column<Rotation>(), kMany * sizeof(Rotation)));
                }),
                kMany);
        });
    bench.add(
        {0,
         "state hash; vs hashing the raw arrays",
         kMany,
         "ns",
         times[0],
         times[1],
         {},
         Figure::OfRaw,
         0,
         ""});
}

}  // namespace limn::bench
