#include "bench/micro/ecs_iteration.h"
#include "bench/micro/ecs_measure.h"
#include "bench/micro/ecs_report.h"
#include "bench/micro/ecs_structure.h"
#include "bench/micro/ecs_workloads.h"
#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// How fast the ECS is, beside raw arrays in the same process.
//
//     ecs_bench [--quick] [--only GROUP] [--json FILE] [--csv FILE] [--svg FILE]
//
// The ECS and the raw loop take turns, 15 times (7 where each repeat needs a new world), and the
// median of each counts; on a machine that does other things too, also the best. Times are per
// entity, unless the unit says otherwise, and stand beside their ratio to the raw loop and to R:
// position += velocity * step over a million raw rows, in turns with the rest. Where a gate is
// known for the figure, the line says whether it is reached. Both sides compute the same; their
// results are compared to the last bit, so that neither can be optimized away or do less. One
// thread, unless the workload says otherwise. --only takes the groups of main() that contain the
// word; --quick repeats less.
//
// Not here: the gate for the compile time, and toggled components, of which there are none.

namespace {

using namespace limn;
using namespace limn::bench;

// ---- access
// -------------------------------------------------------------------------------------

void random_get(Bench& bench, std::size_t count, double limit) {
    World world;
    const std::vector<Entity> entities = fill<Position, Velocity, Rotation>(world, count);
    const RawArrays<Position> arrays(count);
    arrays.start_all();
    const std::vector<std::uint32_t> order = shuffled(count);
    std::vector<Entity> mixed;
    for (const std::uint32_t i : order) {
        mixed.push_back(entities[i]);
    }
    const std::size_t rounds = std::max<std::size_t>(1, 200'000 / count);
    float raw_sum = 0;
    float ecs_sum = 0;
    const auto get_raw = [&] {
        const double time = time_of([&] {
            const Position* positions = arrays.column<Position>();
            for (std::size_t round = 0; round < rounds; ++round) {
                raw_sum = 0;
                for (const std::uint32_t i : order) {
                    raw_sum += positions[i].x;
                }
                keep(raw_sum);
            }
        });
        return per(time, rounds * count);
    };
    const auto get_ecs = [&] {
        const World& readable = world;
        const double time = time_of([&] {
            for (std::size_t round = 0; round < rounds; ++round) {
                ecs_sum = 0;
                for (const Entity entity : mixed) {
                    ecs_sum += readable.get<Position>(entity).x;
                }
                keep(ecs_sum);
            }
        });
        return per(time, rounds * count);
    };
    const auto times = take_turns(
        bench.repeats, [&] { return bench.time_reference(); }, get_raw, get_ecs);
    bench.check(raw_sum == ecs_sum, "random get");
    bench.add(
        {16, "random get", count, "ns", times[2], times[1], times[0], Figure::OfReference, limit});
}

void memory(Bench& bench) {
    World world;
    create_bulk(world);
    const double bytes = static_cast<double>(world.memory().total()) / static_cast<double>(kMany);
    bench.add(
        {17, "memory, 40 B payload", kMany, "B", {bytes, bytes}, {48, 48}, {}, Figure::Plain, 60});
}

void changed(Bench& bench) {
    World world;
    const std::vector<Entity> entities = fill<Position, Velocity>(world, kMany);
    const RawArrays<Position> arrays(kMany);
    std::uint32_t moment = world.version();
    std::size_t seen = 0;
    const auto query = world.query<const Position, Changed<Position>>();
    const auto look = [&] {
        constexpr int kRounds = 1000;
        const double time = time_of([&] {
            for (int i = 0; i < kRounds; ++i) {
                query.since(moment).each([&](const Position&) { ++seen; });
                keep(seen);
            }
        });
        return time / kRounds;
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
    const auto times = take_turns(bench.repeats, read_raw, look);
    bench.check(seen == 0, "nothing changed");
    world.get<Position>(entities[5000]).x = 1;
    query.since(moment).each([&](const Position&) { ++seen; });
    bench.check(seen == 1024, "one chunk changed");
    bench.add(
        {23,
         "changed since, nothing changed",
         kMany,
         "ns/call",
         times[1],
         times[0],
         {},
         Figure::Plain,
         2000});
}

// ---- systems and threads
// ------------------------------------------------------------------------

template <std::size_t number>
void idle(Query<Fragment<static_cast<int>(number)>> rows) {
    keep(rows);
}

void empty_schedule(Bench& bench) {
    constexpr std::size_t kSystems = 100;
    constexpr int kRounds = 100;
    World world;
    Schedule schedule;
    const auto add = [&]<std::size_t... numbers>(std::index_sequence<numbers...>) {
        (schedule.add<idle<numbers>>(), ...);
    };
    add(std::make_index_sequence<kSystems>{});
    const auto run = [&] {
        const double time = time_of([&] {
            for (int i = 0; i < kRounds; ++i) {
                schedule.run(world);
            }
        });
        return time / kRounds;
    };
    run();
    const auto times = take_turns(bench.repeats, run);
    bench.check(schedule.timings()[99].runs > 0, "empty schedule");
    bench.add(
        {20, "schedule of 100 idle systems", 0, "ns/run", times[0], {}, {}, Figure::Plain, 10000});
}

/// The kernel on 1 and 2 threads, over a world and over raw arrays.
template <typename... Terms, typename Kernel>
std::array<Timing, 4>
run_on_threads(Bench& bench, std::size_t count, const Kernel& kernel, const char* name) {
    World world;
    fill<std::remove_const_t<Terms>...>(world, count);
    const RawArrays<std::remove_const_t<Terms>...> arrays(count);
    arrays.start_all();
    const auto query = world.query<Terms...>();
    // Threads are made when there is work, and move to a core of their own after a while.
    const auto start_threads = [](int threads) {
        set_thread_count(threads);
        parallel_for(64, 1, [](std::size_t, std::size_t) {
            for (double spent = 0; spent < 2e5;) {
                spent += time_of([] {});
            }
        });
    };
    const auto run_ecs = [&](int threads) {
        start_threads(threads);
        return per(
            time_of([&] {
                query.par_chunks([&](ChunkView chunk, std::span<Terms>... columns) {
                    const std::size_t size = chunk.size();
                    for (std::size_t i = 0; i < size; ++i) {
                        kernel(columns[i]...);
                    }
                });
            }),
            count);
    };
    const auto run_raw = [&](int threads) {
        start_threads(threads);
        return per(
            time_of([&] {
                parallel_for(count, 1024, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                        kernel(arrays.template column<std::remove_const_t<Terms>>()[i]...);
                    }
                });
            }),
            count);
    };
    const int threads = thread_count();
    const auto times = take_turns(
        bench.repeats,
        [&] { return run_ecs(1); },
        [&] { return run_ecs(2); },
        [&] { return run_raw(1); },
        [&] { return run_raw(2); });
    set_thread_count(threads);
    std::uint64_t sum = 0;
    arrays.each(RowSum{&sum});
    bench.check(sum_of(query) == sum, name);
    return times;
}

void on_threads(Bench& bench) {
    const auto compute = run_on_threads<Scale>(bench, 100'000, Compute{}, "compute on threads");
    const auto bandwidth =
        run_on_threads<const Velocity, Position>(bench, kMany, Move{}, "move on threads");
    const auto row = [&](int gate,
                         const char* name,
                         std::size_t count,
                         const Timing& time,
                         const Timing& raw,
                         double limit) {
        bench.add({gate, name, count, "ns", time, raw, {}, Figure::Speedup, limit});
    };
    row(18, "compute on 2 threads, over 1 thread", 100'000, compute[1], compute[0], 1.85);
    row(0, "    the raw loop, over 1 thread", 100'000, compute[3], compute[2], 0);
    row(19, "2 columns on 2 threads, over the raw loop", kMany, bandwidth[1], bandwidth[3], 0.9);
    row(0, "2 columns on 2 threads, over 1 thread", kMany, bandwidth[1], bandwidth[0], 0);
    row(0, "    the raw loop, over 1 thread", kMany, bandwidth[3], bandwidth[2], 0);
}

void hashes(Bench& bench) {
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
    set_thread_count(1);
    std::sort(found.begin(), found.end());
    const double different =
        static_cast<double>(std::unique(found.begin(), found.end()) - found.begin());
    bench.add(
        {21,
         "different state hashes on 1 .. 64 threads",
         50'001,
         "hashes",
         {different, different},
         {},
         {},
         Figure::Plain,
         1});

    World world;
    fill<Position, Velocity, Rotation>(world, kMany);
    const Payload arrays(kMany);
    const auto times = take_turns(
        bench.slow_repeats,
        [&] {
            return per(
                time_of([&] {
                    keep(hash_bytes(arrays.column<Entity>(), kMany * sizeof(Entity)));
                    keep(hash_bytes(arrays.column<Position>(), kMany * sizeof(Position)));
                    keep(hash_bytes(arrays.column<Velocity>(), kMany * sizeof(Velocity)));
                    keep(hash_bytes(arrays.column<Rotation>(), kMany * sizeof(Rotation)));
                }),
                kMany);
        },
        [&] { return per(time_of([&] { keep(state_hash(world)); }), kMany); });
    set_thread_count(threads);
    bench.add({0, "state hash, 1 thread", kMany, "ns", times[1], times[0], {}, Figure::OfRaw, 0});
}

struct Options {
    bool quick = false;
    std::string json;
    std::string csv;
    std::string svg;
    std::string only;  ///< the groups whose name contains it
};

/// False: not understood.
bool parse(int argc, char** argv, Options& options) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        std::string* file = word == "--json"   ? &options.json
                            : word == "--csv"  ? &options.csv
                            : word == "--svg"  ? &options.svg
                            : word == "--only" ? &options.only
                                               : nullptr;
        if (word == "--quick") {
            options.quick = true;
        } else if (file != nullptr && i + 1 < argc) {
            *file = argv[++i];
        } else {
            return false;
        }
    }
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    if (!parse(argc, argv, options)) {
        fmt::print(
            stderr,
            "usage: ecs_bench [--quick] [--only GROUP] [--json FILE] [--csv FILE] [--svg FILE]\n");
        return 2;
    }
    Bench bench;
    if (options.quick) {
        bench.repeats = 5;
        bench.slow_repeats = 3;
    }
    fmt::print("{}", table_head());
    std::vector<Curve> curves;
    const std::pair<std::string_view, std::function<void()>> groups[] = {
        {"iteration", [&] { iteration(bench); }},
        {"fragmented", [&] { fragmented(bench); }},
        {"churn", [&] { after_churn(bench); }},
        {"create", [&] { create(bench); }},
        {"destroy", [&] { destroy(bench); }},
        {"add", [&] { add_and_remove(bench); }},
        {"deferred", [&] { deferred(bench); }},
        {"get", [&] { random_get(bench, kCached, 4.7), random_get(bench, kMany, 18); }},
        {"memory", [&] { memory(bench); }},
        {"changed", [&] { changed(bench); }},
        {"schedule", [&] { empty_schedule(bench); }},
        {"threads", [&] { on_threads(bench); }},
        {"hash", [&] { hashes(bench); }},
        {"growth", [&] { curves = growth(bench, options.quick ? 1'000'000 : 10'000'000); }},
    };
    for (const auto& [name, run] : groups) {
        if (name.find(options.only) != std::string_view::npos) {
            run();
        }
    }

    bool written = true;
    const auto write = [&](const std::string& path, const std::string& text) {
        written = (path.empty() || write_file(path, text)) && written;
    };
    write(options.json, to_json(bench.rows));
    write(options.csv, to_csv(bench.rows));
    write(options.svg, to_svg("position += velocity * step: time an entity", curves));
    return bench.failed || !written ? 1 : 0;
}
