#pragma once

#include "bench/micro/ecs_measure.h"
#include "ecs/snapshot.h"

#include <cstddef>
#include <cstring>
#include <vector>

// Snapshots compared with copying as many bytes, the lower bound of any method to save a world.

namespace limn::bench {

/// Saving allocates new memory, restoring writes to memory in use; the copies do the same. Beyond
/// copying, both hash every byte (some 9 ns per entity on one thread).
inline void snapshot(Bench& bench) {
    World world;
    const std::vector<Entity> entities =
        fill<Position, Velocity, Rotation, Turn, Tint, Life, Scale>(world, kMany);
    SnapshotMark mark;
    const std::vector<std::byte> saved = save_snapshot(world, &mark).value();
    const std::uint64_t hash = state_hash(world);
    std::vector<std::byte> used(saved);
    std::vector<std::byte> made;
    const auto in_turns = [&](auto&& raw, auto&& ecs) {
        return take_turns(
            bench.slow_repeats, [&] { return bench.time_reference(); }, raw, ecs);
    };
    const auto add = [&](const char* name, const std::array<Timing, 3>& times) {
        bench.add({0, name, kMany, "ns", times[2], times[1], times[0], Figure::OfRaw, 0, ""});
    };

    add("save a snapshot, 92 B/entity",
        in_turns(
            [&] {
                made = {};
                return per(time_of([&] { made = std::vector<std::byte>(saved); }), kMany);
            },
            [&] {
                made = {};
                return per(time_of([&] { made = save_snapshot(world).value(); }), kMany);
            }));
    bench.check(made == saved, "saved twice");
    const auto restore = [&] {
        return per(time_of([&] { keep(restore_snapshot(world, saved, &mark).ok()); }), kMany);
    };
    add("restore it", in_turns(
                          [&] {
                              return per(
                                  time_of([&] {
                                      std::memcpy(used.data(), saved.data(), saved.size());
                                      keep(used[0]);
                                  }),
                                  kMany);
                          },
                          restore));
    bench.check(state_hash(world) == hash, "restored");

    const auto delta = [&](const char* name, std::size_t step) {
        const auto times = take_turns(bench.repeats, [&] {
            for (std::size_t i = 0; i < kMany; i += step) {
                world.get<Position>(entities[i]).x += 1;
            }
            return time_of([&] { made = save_delta(world, mark, &mark).value(); });
        });
        bench.add({0, name, kMany, "ns", times[0], {}, {}, Figure::Plain, 0, ""});
        const auto size = static_cast<double>(made.size());
        bench.add({0, "    its size", kMany, "B", {size, size}, {}, {}, Figure::Plain, 0, ""});
    };
    delta("delta, one value of a million written", kMany);
    delta("delta, a column written", 512);
    std::vector<std::byte> later = save_snapshot(world, &mark).value();
    world.get<Position>(entities[7]).x += 1;
    made = save_delta(world, mark).value();
    add("apply a delta of one value",
        in_turns(
            [&] { return per(time_of([&] { keep(std::vector<std::byte>(later)); }), kMany); },
            [&] { return per(time_of([&] { keep(apply_delta(later, made).ok()); }), kMany); }));
}

}  // namespace limn::bench
