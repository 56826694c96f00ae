#pragma once

#include "bench/micro/ecs_measure.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

// Toggle components, enabled and disabled in place: by handle, and the cost of testing the bits
// during iteration. Adding and removing the same component is in ecs_structure.h.

namespace limn::bench {

struct ToggledExtra {
    float value[4] = {1, 2, 3, 4};
};
struct Awake {};

}  // namespace limn::bench

template <>
struct limn::ComponentTraits<limn::bench::ToggledExtra> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<limn::bench::Awake> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};

namespace limn::bench {

inline void toggle_by_handle(Bench& bench) {
    World world;
    const std::vector<Entity> entities =
        world.create_many(kMany, Position{}, Velocity{}, Rotation{}, ToggledExtra{});
    std::vector<Entity> mixed;
    for (const std::uint32_t i : shuffled(kMany)) {
        mixed.push_back(entities[i]);
    }
    std::vector<std::uint8_t> flags(kMany, 1);
    // Off and on again: two changes per entity.
    const auto all = [&](const std::vector<Entity>& order, const auto& off, const auto& on) {
        return per(
            time_of([&] {
                std::for_each(order.begin(), order.end(), off);
                keep(order);
                std::for_each(order.begin(), order.end(), on);
                keep(order);
            }),
            2 * kMany);
    };
    const auto bits = [&](const std::vector<Entity>& order) {
        return all(
            order, [&](Entity entity) { world.disable<ToggledExtra>(entity); },
            [&](Entity entity) { world.enable<ToggledExtra>(entity); });
    };
    const auto bytes = [&](const std::vector<Entity>& order) {
        return all(
            order, [&](Entity entity) { flags[entity.index] = 0; },
            [&](Entity entity) { flags[entity.index] = 1; });
    };
    const auto times = take_turns(
        bench.repeats, [&] { return bench.time_reference(); }, [&] { return bytes(entities); },
        [&] { return bits(entities); }, [&] { return bytes(mixed); }, [&] { return bits(mixed); });
    bench.check(world.query<With<ToggledExtra>>().count() == kMany, "enable");
    world.disable<ToggledExtra>(entities[5]);
    bench.check(world.query<With<ToggledExtra>>().count() == kMany - 1, "disable");
    const auto row = [&](int gate, const char* name, const Timing& ecs, const Timing& raw,
                         double limit) {
        bench.add({gate, name, kMany, "ns", ecs, raw, times[0], Figure::OfReference, limit, ""});
    };
    row(13, "toggle, one by one, order of creation", times[2], times[1], 5);
    row(0, "toggle, one by one, random order", times[4], times[3], 0);
}

/// Two columns where a random fraction `enabled` of the rows is enabled, compared with arrays and a
/// flag byte per row.
inline void iterate_enabled(Bench& bench, const char* name, double enabled) {
    World world;
    const std::vector<Entity> entities = world.create_many(kMany, Position{}, Velocity{}, Awake{});
    const RawArrays<Position, Velocity> arrays(kMany);
    arrays.start_all();
    Position* positions = arrays.column<Position>();
    const Velocity* velocities = arrays.column<Velocity>();
    std::vector<std::uint8_t> flags(kMany);
    for (std::size_t i = 0; i < kMany; ++i) {
        world.get<Position>(entities[i]) = positions[i];
        world.get<Velocity>(entities[i]) = velocities[i];
        flags[i] = static_cast<std::uint8_t>(noise(i, 20) < static_cast<float>(enabled) - 0.5f);
        world.set_enabled<Awake>(entities[i], flags[i] != 0);
    }
    const auto query = world.query<const Velocity, Position, With<Awake>>();
    const auto times = take_turns(
        bench.repeats,
        [&] {
            return per(
                time_of([&] {
                    for (std::size_t i = 0; i < kMany; ++i) {
                        if (flags[i] != 0) {
                            Move()(velocities[i], positions[i]);
                        }
                    }
                    keep(positions);
                }),
                kMany);
        },
        [&] { return per(time_of([&] { query.each(Move{}); }), kMany); });
    bool same = true;
    for (std::size_t i = 0; i < kMany; ++i) {
        same = same && world.get<const Position>(entities[i]).x == positions[i].x;
    }
    bench.check(same, name);
    bench.add({0, name, kMany, "ns", times[1], times[0], {}, Figure::OfRaw, 0, ""});
}

inline void toggles(Bench& bench) {
    toggle_by_handle(bench);
    iterate_enabled(bench, "2 columns, no row enabled", 0.0);
    iterate_enabled(bench, "2 columns, half the rows enabled, at random", 0.5);
    iterate_enabled(bench, "2 columns, every row enabled", 1.01);
}

}  // namespace limn::bench
