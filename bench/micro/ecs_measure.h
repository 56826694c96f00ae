#pragma once

#include "bench/micro/ecs_report.h"
#include "bench/micro/ecs_workloads.h"
#include "ecs/base/jobs.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>

// How ecs_bench measures: alternating between the candidates, so that disturbances of the machine
// affect all alike.

namespace limn::bench {

inline constexpr std::size_t kSmall = 64;
inline constexpr std::size_t kCached = 16384;
inline constexpr std::size_t kMany = 1'000'000;

/// 40 bytes, 3 components, and the handle.
using Payload = RawArrays<Entity, Position, Velocity, Rotation>;

/// A run of the program.
struct Bench {
    int repeats = 15;
    int slow_repeats = 7;  ///< for workloads that need a new world each time
    Report report;
    bool failed = false;
    /// The arrays that R is measured on, in ordinary memory.
    std::vector<Velocity> reference_velocities = std::vector<Velocity>(kMany);
    std::vector<Position> reference_positions = std::vector<Position>(kMany);

    void add(Row row) {
        fmt::print("{}", table_line(row));
        std::fflush(stdout);
        report.rows.push_back(std::move(row));
    }
    void check(bool condition, std::string_view what) {
        if (!condition) {
            fmt::print(stderr, "wrong result: {}\n", what);
            failed = true;
        }
    }
    /// Whether there is enough memory for a workload; prints a line if not.
    [[nodiscard]] bool fits(std::string_view name, std::size_t count, std::size_t bytes) const {
        const double free = static_cast<double>(sysconf(_SC_AVPHYS_PAGES))
                            * static_cast<double>(sysconf(_SC_PAGESIZE));
        if (static_cast<double>(bytes) < 0.8 * free) {
            return true;
        }
        fmt::print(
            "skipped: {} with {} entities, which needs {} MiB of memory\n", name, count,
            bytes >> 20);
        return false;
    }
    /// R [ns]
    [[nodiscard]] double time_reference() {
        return time_of([&] {
                   move_all(kMany, reference_velocities.data(), reference_positions.data());
               })
               / static_cast<double>(kMany);
    }

  private:
    [[gnu::noinline]] static void
    move_all(std::size_t count, const Velocity* velocities, Position* positions) {
        for (std::size_t i = 0; i < count; ++i) {
            Move()(velocities[i], positions[i]);
        }
    }
};

/// Median and best of the samples.
[[nodiscard]] inline Timing timing_of(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return {times[times.size() / 2], times.front()};
}

/// Calls the functions alternately; each returns its time.
template <typename... Fs>
std::array<Timing, sizeof...(Fs)> take_turns(int repeats, Fs&&... functions) {
    std::array<std::vector<double>, sizeof...(Fs)> times;
    for (int i = 0; i < repeats; ++i) {
        std::size_t which = 0;
        (times[which++].push_back(functions()), ...);
    }
    std::array<Timing, sizeof...(Fs)> timings;
    std::transform(times.begin(), times.end(), timings.begin(), timing_of);
    return timings;
}

/// Mean time of a call, over enough rounds for the timer's resolution.
template <typename F>
[[nodiscard]] double time_of_rounds(std::size_t rounds, F&& once) {
    return time_of([&] {
               for (std::size_t i = 0; i < rounds; ++i) {
                   once();
                   keep(rounds);
               }
           })
           / static_cast<double>(rounds);
}
[[nodiscard]] inline std::size_t rounds_for(std::size_t count) {
    return std::max<std::size_t>(1, 200'000 / count);
}

[[nodiscard]] inline double per(double time, std::size_t count) {
    return time / static_cast<double>(count);
}

inline Timing scaled(const Timing& timing, double factor) {
    return {timing.median * factor, timing.best * factor};
}

inline Timing beyond(const Timing& timing, const Timing& other) {
    return {timing.median - other.median, timing.best - other.best};
}

/// Sets the number of threads and warms them up: they are created with the first work, and settle
/// on their own cores after a while.
inline void start_threads(int threads) {
    set_thread_count(threads);
    parallel_for(64, 1, [](std::size_t, std::size_t) {
        for (double spent = 0; spent < 2e5;) {
            spent += time_of([] {});
        }
    });
}

/// A world of `count` entities with their start values.
template <typename... Ts>
std::vector<Entity> fill(World& world, std::size_t count) {
    std::vector<Entity> entities = world.create_many(count, Ts{}...);
    world.query<Ts...>().each([row = std::size_t{0}](Ts&... values) mutable {
        (start(values, row), ...);
        ++row;
    });
    return entities;
}

template <typename Query>
std::uint64_t sum_of(const Query& query) {
    std::uint64_t sum = 0;
    query.each(RowSum{&sum});
    return sum;
}

}  // namespace limn::bench
