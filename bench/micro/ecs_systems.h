#pragma once

#include "bench/micro/ecs_measure.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

// Systems and threads: the overhead of an idle schedule, the speedup of a second thread, and
// whether results depend on the number of threads.

namespace limn::bench {

template <std::size_t number>
void idle(Query<Fragment<static_cast<int>(number)>> rows) {
    keep(rows);
}

inline void empty_schedule(Bench& bench) {
    constexpr std::size_t kSystems = 100;
    World world;
    Schedule schedule;
    const auto add = [&]<std::size_t... numbers>(std::index_sequence<numbers...>) {
        (schedule.add<idle<numbers>>(), ...);
    };
    add(std::make_index_sequence<kSystems>{});
    using Call = void (*)(int);
    volatile Call raw = [](int number) { keep(number); };
    schedule.run(world);
    const auto times = take_turns(
        bench.repeats, [&] { return time_of_rounds(100, [&] { schedule.run(world); }); },
        [&] {
            return time_of_rounds(100, [&] {
                for (int i = 0; i < static_cast<int>(kSystems); ++i) {
                    raw(i);
                }
            });
        });
    bench.check(schedule.timings()[99].runs > 0, "empty schedule");
    bench.add(
        {20,
         "schedule of 100 idle systems; vs 100 calls",
         0,
         "ns/run",
         times[0],
         times[1],
         {},
         Figure::Plain,
         10000,
         ""});
}

// ---- threads

/// A kernel over a world and over raw arrays, on 1 thread and on several.
struct ThreadTimes {
    Timing ecs;
    Timing ecs_threads;
    Timing raw;
    Timing raw_threads;
};

/// The raw loop uses the same number of rows per task as the query.
template <typename... Terms, typename Kernel>
ThreadTimes
run_on_threads(Bench& bench, std::size_t count, int threads, int repeats, const Kernel& kernel) {
    World world;
    fill<std::remove_const_t<Terms>...>(world, count);
    const RawArrays<std::remove_const_t<Terms>...> arrays(count);
    arrays.start_all();
    const auto query = world.query<Terms...>();
    const auto run_ecs = [&] {
        return time_of([&] {
            query.par_chunks([&](ChunkView chunk, std::span<Terms>... columns) {
                const std::size_t size = chunk.size();
                for (std::size_t i = 0; i < size; ++i) {
                    kernel(columns[i]...);
                }
            });
        });
    };
    const auto run_raw = [&] {
        return time_of([&] {
            parallel_for(count, kChunkRows, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    kernel(arrays.template column<std::remove_const_t<Terms>>()[i]...);
                }
            });
        });
    };
    const auto timed = [&](const auto& run) { return per(run(), count); };
    const int before = thread_count();
    set_thread_count(1);
    const auto one = take_turns(
        repeats, [&] { return timed(run_ecs); }, [&] { return timed(run_raw); });
    start_threads(threads);
    const auto several = take_turns(
        repeats, [&] { return timed(run_ecs); }, [&] { return timed(run_raw); });
    set_thread_count(before);
    std::uint64_t sum = 0;
    arrays.each(RowSum{&sum});
    bench.check(sum_of(query) == sum, "on threads");
    return {one[0], several[0], one[1], several[1]};
}

inline void on_threads(Bench& bench) {
    constexpr std::size_t kComputed = 100'000;
    const auto compute = run_on_threads<Scale>(bench, kComputed, 2, 2 * bench.repeats, Compute{});
    const auto bandwidth =
        run_on_threads<const Velocity, Position>(bench, kMany, 2, 2 * bench.repeats, Move{});
    const auto row = [&](int gate, const char* name, std::size_t count, const Timing& time,
                         const Timing& raw, double limit) {
        bench.add({gate, name, count, "ns", time, raw, {}, Figure::Speedup, limit, ""});
    };
    row(18, "compute on 2 threads, over 1 thread", kComputed, compute.ecs_threads, compute.ecs,
        1.85);
    row(0, "    the raw loop, over 1 thread", kComputed, compute.raw_threads, compute.raw, 0);
    row(19, "2 columns on 2 threads, over the raw loop", kMany, bandwidth.ecs_threads,
        bandwidth.raw_threads, 0.9);
    row(0, "    over 1 thread", kMany, bandwidth.ecs_threads, bandwidth.ecs, 0);
    row(0, "    the raw loop, over 1 thread", kMany, bandwidth.raw_threads, bandwidth.raw, 0);

    // Overhead of a task and of a parallel query: chunks without work.
    World world;
    fill<Scale>(world, kMany);
    const auto query = world.query<const Scale>();
    const auto run_idle_tasks = [&] {
        return time_of([&] {
            query.par_chunks([](ChunkView chunk, std::span<const Scale>) { keep(chunk); });
        });
    };
    const int before = thread_count();
    start_threads(2);
    const auto tasks = take_turns(4 * bench.repeats, [&] {
        return per(run_idle_tasks(), chunks_of(static_cast<std::uint32_t>(kMany)));
    });
    set_thread_count(before);
    bench.add(
        {0,
         "    an idle task of par_chunks, 2 threads",
         kMany,
         "ns/task",
         tasks[0],
         {},
         {},
         Figure::Plain,
         0,
         ""});
}

inline void hashes(Bench& bench) {
    const int threads = thread_count();
    std::vector<std::uint64_t> found;
    for (const int count : {1, 2, 3, 7, 16, 64}) {
        set_thread_count(count);
        World world;
        fill<Scale, Velocity, Position>(world, 50'001);
        world.query<const Velocity, Position>().par_each(Move{});
        world.query<Scale>().par_each(Compute{});
        found.push_back(state_hash(world));
    }
    set_thread_count(threads);
    std::sort(found.begin(), found.end());
    const double different =
        static_cast<double>(std::unique(found.begin(), found.end()) - found.begin());
    bench.add(
        {21,
         "different state hashes on 1, 2, 3, 7, 16, 64 threads",
         50'001,
         "hashes",
         {different, different},
         {},
         {},
         Figure::Plain,
         1,
         ""});
}

}  // namespace limn::bench
