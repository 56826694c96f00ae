#pragma once

#include "bench/micro/ecs_report.h"
#include "bench/micro/ecs_workloads.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

// How ecs_bench measures: in turns, so that what disturbs the machine disturbs all alike.

namespace limn::bench {

inline constexpr std::size_t kSmall = 64;
inline constexpr std::size_t kCached = 16384;
inline constexpr std::size_t kMany = 1'000'000;

/// A run of the program.
struct Bench {
    int repeats = 15;
    int slow_repeats = 7;  ///< of what needs a new world each time
    std::vector<Row> rows;
    bool failed = false;
    RawArrays<Velocity, Position> reference{kMany};

    Bench() { reference.start_all(); }

    void add(Row row) {
        fmt::print("{}", table_line(row));
        std::fflush(stdout);
        rows.push_back(std::move(row));
    }
    void check(bool condition, std::string_view what) {
        if (!condition) {
            fmt::print(stderr, "wrong result: {}\n", what);
            failed = true;
        }
    }
    /// R [ns]
    [[nodiscard]] double time_reference() const {
        return time_of([&] { reference.each(Move{}); }) / static_cast<double>(kMany);
    }
};

/// Calls the functions in turns; each returns its time.
template <typename... Fs>
std::array<Timing, sizeof...(Fs)> take_turns(int repeats, Fs&&... functions) {
    std::array<std::vector<double>, sizeof...(Fs)> times;
    for (int i = 0; i < repeats; ++i) {
        std::size_t which = 0;
        (times[which++].push_back(functions()), ...);
    }
    std::array<Timing, sizeof...(Fs)> timings;
    for (std::size_t i = 0; i < times.size(); ++i) {
        std::sort(times[i].begin(), times[i].end());
        timings[i] = {times[i][times[i].size() / 2], times[i].front()};
    }
    return timings;
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
