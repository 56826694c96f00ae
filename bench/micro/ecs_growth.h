#pragma once

#include "bench/micro/ecs_access.h"
#include "bench/micro/ecs_iteration.h"
#include "bench/micro/ecs_structure.h"
#include "bench/micro/ecs_systems.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// How times grow with the number of entities, from 1e3 to 1e7: the curves of the plot. Then, for
// every bulk operation, whether twice as many entities take twice as long: the gate is time(2n) <=
// 2.3 time(n), the median over several n.

namespace limn::bench {

/// An operation on all entities of a new world. Both functions return its total time [ns].
struct Operation {
    std::string name;
    std::size_t bytes = 0;  ///< memory needed per entity
    std::function<double(std::size_t count)> ecs;
    std::function<double(std::size_t count)> raw;  ///< called after `ecs`
};

inline std::vector<Operation> bulk_operations(Bench& bench) {
    const auto copy_rows = [](std::size_t count) { return RawMove(count).time(); };
    const auto deferred_add = [&bench, systems = std::make_shared<Deferred>()](std::size_t count) {
        return systems->time_all(bench, count).both();
    };
    const auto found = std::make_shared<SnapshotTimes>();  // of the world last saved
    const auto snapshot = [&bench, found](std::size_t count) {
        World world;
        fill<Position, Velocity, Rotation, Turn, Tint, Life, Scale>(world, count);
        *found = time_snapshot(bench, world);
    };
    const auto copy_bytes = [found](std::size_t) { return found->copy; };
    return {
        {"create, one by one", 150,
         [&](std::size_t count) {
             return time_create(bench, count, create_one_by_one, Memory::Fresh);
         },
         time_raw_fill},
        {"create, bulk", 150,
         [&](std::size_t count) { return time_create(bench, count, create_bulk, Memory::Fresh); },
         time_raw_fill},
        {"destroy, one by one", 100,
         [&](std::size_t count) { return time_destroy(bench, count, Order::Creation); },
         time_raw_free},
        {"destroy, all of a query", 100,
         [&](std::size_t count) { return time_destroy_all(bench, count, destroy_by_query); },
         time_raw_free},
        {"add, one by one", 400,
         [&](std::size_t count) { return time_add_and_remove<Extra>(bench, count).add; },
         copy_rows},
        {"remove, one by one", 400,
         [&](std::size_t count) { return time_add_and_remove<Extra>(bench, count).remove; },
         copy_rows},
        {"add, all of a query", 400,
         [&](std::size_t count) {
             return time_add_and_remove_all(bench, count, Target::Occupied).add;
         },
         copy_rows},
        {"remove, all of a query", 400,
         [&](std::size_t count) {
             return time_add_and_remove_all(bench, count, Target::Occupied).remove;
         },
         copy_rows},
        {"deferred add", 500, deferred_add, copy_rows},
        {"snapshot, save", 300,
         [=](std::size_t count) {
             snapshot(count);
             return found->save;
         },
         copy_bytes},
        {"snapshot, restore", 300,
         [=](std::size_t count) {
             snapshot(count);
             return found->restore;
         },
         copy_bytes},
    };
}

// ---- curves

/// Entity counts, half a decade apart.
inline std::vector<std::size_t> sizes_up_to(std::size_t largest) {
    std::vector<std::size_t> sizes;
    for (double size = 1000; size < 1.1 * static_cast<double>(largest); size *= std::sqrt(10.0)) {
        sizes.push_back(static_cast<std::size_t>(std::lround(size)));
    }
    return sizes;
}

template <typename... Terms, typename Kernel>
void iteration_growth(
    Bench& bench, const std::string& name, std::size_t largest, const Kernel& kernel) {
    for (const std::size_t count : sizes_up_to(largest)) {
        if (!bench.fits(name, count, 2 * count * (sizeof(Terms) + ... + sizeof(Entity)))) {
            continue;
        }
        const int repeats = count > kMany ? bench.slow_repeats : bench.repeats;
        const ThreadTimes times = run_on_threads<Terms...>(bench, count, 2, repeats, kernel);
        const auto row = [&](const std::string& what, const Timing& time, const Timing& raw) {
            bench.add({0, what, count, "ns", time, raw, {}, Figure::OfRaw, 0, what});
        };
        row(name, times.ecs, times.raw);
        row(name + ", 2 threads", times.ecs_threads, times.raw_threads);
    }
}

inline void growth(Bench& bench, std::size_t largest) {
    iteration_growth<const Velocity, Position>(bench, "2 columns", largest, Move{});
    iteration_growth<const Velocity, const Turn, const Scale, Position, Rotation, Tint, Life>(
        bench, "7 columns", largest, Animate{});
    for (const Operation& operation : bulk_operations(bench)) {
        for (const std::size_t count : sizes_up_to(largest)) {
            if (!bench.fits(operation.name, count, count * operation.bytes)) {
                continue;
            }
            const auto times = take_turns(
                count > kMany ? 3 : bench.slow_repeats,
                [&] { return per(operation.ecs(count), count); },
                [&] { return per(operation.raw(count), count); });
            bench.add(
                {0,
                 operation.name,
                 count,
                 "ns",
                 times[0],
                 times[1],
                 {},
                 Figure::OfRaw,
                 0,
                 operation.name});
        }
    }
}

// ---- twice as many

/// time(2n) / time(n) for n = 16k .. 512k.
inline void doubling(Bench& bench) {
    constexpr std::size_t kFirst = 1 << 14;
    constexpr std::size_t kSizes = 7;
    for (const Operation& operation : bulk_operations(bench)) {
        std::vector<double> best(kSizes, INFINITY);
        for (int repeat = 0; repeat < bench.slow_repeats; ++repeat) {
            for (std::size_t i = 0; i < kSizes; ++i) {
                best[i] = std::min(best[i], operation.ecs(kFirst << i));
            }
        }
        std::vector<double> ratios;
        for (std::size_t i = 1; i < kSizes; ++i) {
            ratios.push_back(best[i] / best[i - 1]);
        }
        bench.add(
            {0,
             fmt::format("time(2n) / time(n): {}", operation.name),
             kFirst << (kSizes - 1),
             "times",
             timing_of(ratios),
             {},
             {},
             Figure::Plain,
             2.3,
             ""});
    }
}

}  // namespace limn::bench
