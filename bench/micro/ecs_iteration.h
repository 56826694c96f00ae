#pragma once

#include "bench/micro/ecs_measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// Iteration over components, compared with the same kernel over raw arrays.

namespace limn::bench {

// Both loops are separate, non-inlined functions, so that their code does not depend on the
// surroundings.

template <typename Kernel, typename Query>
[[gnu::noinline]] void run_each(const Query& query, const Kernel& kernel) {
    query.each(kernel);
}

/// The kernel over the spans of every chunk, which is what Query::chunks is for.
template <typename Kernel, typename... Terms>
[[gnu::noinline]] void run_chunks(const Query<Terms...>& query, const Kernel& kernel) {
    query.chunks([&](ChunkView chunk, std::span<Terms>... columns) {
        const std::size_t size = chunk.size();
        for (std::size_t i = 0; i < size; ++i) {
            kernel(columns[i]...);
        }
    });
}

struct IterationTimes {
    Timing raw;
    Timing each;
    Timing chunks;
};

/// [ns per entity]
template <typename... Terms, typename Kernel>
IterationTimes
iterate(Bench& bench, const std::string& name, std::size_t count, const Kernel& kernel) {
    const RawArrays<std::remove_const_t<Terms>...> arrays(count);
    arrays.start_all();
    World each_world;
    World chunk_world;
    fill<std::remove_const_t<Terms>...>(each_world, count);
    fill<std::remove_const_t<Terms>...>(chunk_world, count);
    const Query<Terms...> each_query = each_world.query<Terms...>();
    const Query<Terms...> chunk_query = chunk_world.query<Terms...>();

    const auto timed = [&](auto&& once) {
        return per(time_of_rounds(rounds_for(count), once), count);
    };
    const auto times = take_turns(
        bench.repeats, [&] { return timed([&] { arrays.each(kernel); }); },
        [&] { return timed([&] { run_each(each_query, kernel); }); },
        [&] { return timed([&] { run_chunks(chunk_query, kernel); }); });

    std::uint64_t sum = 0;
    arrays.each(RowSum{&sum});
    bench.check(sum_of(each_query) == sum, name + ", each");
    bench.check(sum_of(chunk_query) == sum, name + ", chunks");
    return {times[0], times[1], times[2]};
}

template <typename... Terms, typename Kernel>
void iteration_rows(
    Bench& bench, const std::string& name, std::size_t count, const Kernel& kernel, int gate,
    double limit) {
    const IterationTimes times = iterate<Terms...>(bench, name, count, kernel);
    bench.add(
        {gate, name + ", each", count, "ns", times.each, times.raw, {}, Figure::OfRaw, limit, ""});
    bench.add(
        {gate,
         name + ", chunks",
         count,
         "ns",
         times.chunks,
         times.raw,
         {},
         Figure::OfRaw,
         limit,
         ""});
}

inline void iteration(Bench& bench) {
    iteration_rows<const Velocity, Position>(bench, "2 columns", kMany, Move{}, 1, 1.03);
    iteration_rows<const Velocity, Position>(bench, "2 columns", kCached, Move{}, 2, 1.05);
    iteration_rows<const Velocity, Position>(bench, "2 columns", kSmall, Move{}, 0, 0);
    iteration_rows<Position>(bench, "1 column", kMany, Shift{}, 0, 0);
    iteration_rows<Position>(bench, "1 column", kCached, Shift{}, 0, 0);
    iteration_rows<Position>(bench, "1 column", kSmall, Shift{}, 0, 0);
    const auto seven = [&](std::size_t count, int gate, double limit) {
        iteration_rows<const Velocity, const Turn, const Scale, Position, Rotation, Tint, Life>(
            bench, "7 columns", count, Animate{}, gate, limit);
    };
    seven(kMany, 3, 1.03);
    seven(kCached, 4, 1.02);
    seven(kSmall, 0, 0);

    const IterationTimes call =
        iterate<const Velocity, Position>(bench, "one call", kSmall, Move{});
    const double rows = static_cast<double>(kSmall);
    const Timing raw = scaled(call.raw, rows);
    const Timing each = scaled(call.each, rows);
    const Timing chunks = scaled(call.chunks, rows);
    const auto row = [&](int gate, const char* name, const Timing& time, double limit) {
        bench.add({gate, name, kSmall, "ns/call", time, raw, {}, Figure::Plain, limit, ""});
    };
    row(5, "one call over 64 rows, each", each, 20);
    row(5, "one call over 64 rows, chunks", chunks, 20);
    row(0, "    each, beyond the raw loop", beyond(each, raw), 10);
    row(0, "    chunks, beyond the raw loop", beyond(chunks, raw), 10);
}

/// Alternative raw layouts: one array per float, and one struct with all components per entity.
inline void raw_layouts(Bench& bench) {
    struct Fat {
        Position position;
        Velocity velocity;
        Rotation rotation;
        Turn turn;
        Tint tint;
        Life life;
        Scale scale;
    };
    static_assert(sizeof(Fat) == 80);
    for (const std::size_t count : {kSmall, kCached, kMany}) {
        const RawArrays<Velocity, Position> arrays(count);
        arrays.start_all();
        std::vector<float> floats[6];
        for (std::vector<float>& lane : floats) {
            lane.resize(count, 0.5f);
        }
        std::vector<Fat> fat(count);
        const auto move_floats = [](std::size_t size, float* position, const float* velocity) {
            for (std::size_t i = 0; i < size; ++i) {
                position[i] += velocity[i] * kStep;
            }
        };
        const auto timed = [&](auto&& once) {
            return per(time_of_rounds(rounds_for(count), once), count);
        };
        const auto times = take_turns(
            bench.repeats, [&] { return timed([&] { arrays.each(Move{}); }); },
            [&] {
                return timed([&] {
                    for (int lane = 0; lane < 3; ++lane) {
                        move_floats(count, floats[lane].data(), floats[lane + 3].data());
                    }
                });
            },
            [&] {
                return timed([&] {
                    for (Fat& entity : fat) {
                        Move()(entity.velocity, entity.position);
                    }
                });
            });
        const auto row = [&](const char* name, const Timing& time) {
            bench.add({0, name, count, "ns", time, times[0], {}, Figure::OfRaw, 0, ""});
        };
        row("2 columns, no ECS: one array per float", times[1]);
        row("2 columns, no ECS: an array of 80 B structs", times[2]);
    }
}

[[gnu::noinline]] inline void grow_all(std::span<const std::span<Scale>> pieces) {
    for (const std::span<Scale> piece : pieces) {
        for (Scale& scale : piece) {
            Grow()(scale);
        }
    }
}

struct FragmentTimes {
    Timing raw;
    Timing each;
    std::size_t count = 0;
};

/// 26 archetypes of 20 rows each and 4 of `large`, one float per row; the raw loop iterates over a
/// list of as many arrays.
inline FragmentTimes iterate_fragments(Bench& bench, std::size_t large) {
    World world;
    const auto make = [&]<int... numbers>(
        std::size_t rows, std::integer_sequence<int, numbers...>) {
        (world.create_many(rows, Scale{}, Fragment<numbers>{}), ...);
    };
    make(20, std::make_integer_sequence<int, 26>{});
    if (large > 0) {
        make(large, std::integer_sequence<int, 26, 27, 28, 29>{});
    }
    const Query<Scale> query = world.query<Scale>();
    query.each([row = std::size_t{0}](Scale& scale) mutable { start(scale, row++); });
    const std::size_t count = query.count();

    const RawArrays<Scale> arrays(count);
    arrays.start_all();
    std::vector<std::span<Scale>> pieces;
    for (std::size_t begin = 0; begin < count; begin += pieces.back().size()) {
        pieces.emplace_back(arrays.column<Scale>() + begin, pieces.size() < 26 ? 20 : large);
    }
    const auto timed = [&](auto&& once) {
        return per(time_of_rounds(rounds_for(count), once), count);
    };
    const auto times = take_turns(
        bench.repeats, [&] { return timed([&] { grow_all(pieces); }); },
        [&] { return timed([&] { run_each(query, Grow{}); }); });
    std::uint64_t sum = 0;
    arrays.each(RowSum{&sum});
    bench.check(count == 26 * 20 + 4 * large && sum_of(query) == sum, "fragments");
    return {times[0], times[1], count};
}

inline void fragmented(Bench& bench) {
    const FragmentTimes small = iterate_fragments(bench, 0);
    const FragmentTimes large = iterate_fragments(bench, 25'000);
    const auto row = [&](int gate, const char* name, const FragmentTimes& times, double limit) {
        bench.add(
            {gate, name, times.count, "ns", times.each, times.raw, {}, Figure::OfRaw, limit, ""});
    };
    row(6, "26 archetypes x 20 rows, each", small, 1.6);
    row(0, "26 x 20 and 4 x 25,000 rows, each", large, 0);
    const Timing visit = scaled(beyond(small.each, small.raw), 20);
    bench.add(
        {0,
         "    an archetype, beyond the raw loop",
         small.count,
         "ns",
         visit,
         {},
         {},
         Figure::Plain,
         2,
         ""});
}

/// After every entity's velocity was removed and added back, in random order.
inline void after_churn(Bench& bench) {
    World world;
    const std::vector<Entity> entities = fill<Velocity, Position>(world, kMany);
    for (const std::uint32_t i : shuffled(kMany)) {
        const Velocity velocity = world.get<const Velocity>(entities[i]);
        world.remove<Velocity>(entities[i]);
        world.add(entities[i], velocity);
    }
    const RawArrays<Velocity, Position> arrays(kMany);
    arrays.start_all();
    const auto query = world.query<const Velocity, Position>();
    const auto times = take_turns(
        bench.repeats, [&] { return per(time_of([&] { arrays.each(Move{}); }), kMany); },
        [&] { return per(time_of([&] { run_each(query, Move{}); }), kMany); });
    std::uint64_t sum = 0;
    arrays.each(RowSum{&sum});
    bench.check(sum_of(query) == sum, "after churn");
    bench.add(
        {7,
         "2 columns after churn, each",
         kMany,
         "ns",
         times[1],
         times[0],
         {},
         Figure::OfRaw,
         1.03,
         ""});
}

}  // namespace limn::bench
