#pragma once

#include "bench/micro/ecs_measure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Split components (structure of arrays: a column per scalar, for SIMD kernels), compared with a
// column of structs and with raw arrays of scalars.

namespace limn::bench {

struct Sphere {
    float x = 0, y = 0, z = 0, radius = 0.1f;
};
struct SplitSphere {
    float x = 0, y = 0, z = 0, radius = 0.1f;
};
struct SplitRotation {
    float x = 0, y = 0, z = 0, w = 1;
};
struct SplitTurn {
    float x = 0, y = 0, z = 0;
};
struct Visible {
    std::uint32_t yes = 0;
};

inline void start(Sphere& s, std::size_t row) {
    s = {noise(row, 0), noise(row, 1), noise(row, 2), 0.1f};
}
inline void start(SplitSphere& s, std::size_t row) {
    s = {noise(row, 0), noise(row, 1), noise(row, 2), 0.1f};
}
inline void start(SplitRotation& r, std::size_t row) {
    r = {noise(row, 6), 0, 0, 1};
}
inline void start(SplitTurn& t, std::size_t row) {
    t = {noise(row, 7), noise(row, 8), noise(row, 9)};
}
inline void start(Visible& visible, std::size_t) {
    visible = {};
}

}  // namespace limn::bench

template <>
struct limn::ComponentTraits<limn::bench::SplitSphere> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<limn::bench::SplitRotation> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<limn::bench::SplitTurn> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};

namespace limn::bench {

/// Frustum planes, pointing inward: normal and distance.
inline constexpr float kPlanes[6][4] = {{0.9f, 0.1f, 0.2f, 0.4f}, {-0.9f, 0.1f, 0.2f, 0.4f},
                                        {0.1f, 0.9f, 0.2f, 0.4f}, {0.1f, -0.9f, 0.2f, 0.4f},
                                        {0.0f, 0.1f, 0.9f, 0.3f}, {0.0f, 0.1f, -0.9f, 0.3f}};

inline std::uint32_t is_visible(float x, float y, float z, float radius) {
    float smallest = INFINITY;
    for (const auto& plane : kPlanes) {
        const float distance = plane[0] * x + plane[1] * y + plane[2] * z + plane[3];
        smallest = distance < smallest ? distance : smallest;
    }
    return smallest + radius >= 0 ? 1 : 0;
}

[[gnu::noinline]] inline void cull_table(const Query<const Sphere, Visible>& query) {
    query.chunks([](ChunkView chunk, std::span<const Sphere> spheres, std::span<Visible> visible) {
        const std::uint32_t size = chunk.size();
        for (std::uint32_t i = 0; i < size; ++i) {
            const Sphere& s = spheres[i];
            visible[i].yes = is_visible(s.x, s.y, s.z, s.radius);
        }
    });
}

/// Works on plain arrays, from a chunk or from the raw loop.
inline void cull_lanes(
    std::size_t size, const float* x, const float* y, const float* z, const float* radius,
    Visible* visible) {
    for (std::size_t i = 0; i < size; ++i) {
        visible[i].yes = is_visible(x[i], y[i], z[i], radius[i]);
    }
}

[[gnu::noinline]] inline void cull_split(const Query<const SplitSphere, Visible>& query) {
    query.chunks(
        [](ChunkView chunk, SplitSpan<const SplitSphere> spheres, std::span<Visible> visible) {
            cull_lanes(
                chunk.size(), spheres.lane(0).data(), spheres.lane(1).data(),
                spheres.lane(2).data(), spheres.lane(3).data(), visible.data());
        });
}

/// q += (dt / 2) q (t, 0), then q /= |q|.
inline void turn_one(float& x, float& y, float& z, float& w, float tx, float ty, float tz) {
    const float half = 0.5f * kStep;
    const float nx = x + half * (tx * w + ty * z - tz * y);
    const float ny = y + half * (ty * w + tz * x - tx * z);
    const float nz = z + half * (tz * w + tx * y - ty * x);
    const float nw = w - half * (tx * x + ty * y + tz * z);
    const float scale = 1.0f / std::sqrt(nx * nx + ny * ny + nz * nz + nw * nw);
    x = nx * scale;
    y = ny * scale;
    z = nz * scale;
    w = nw * scale;
}

[[gnu::noinline]] inline void turn_table(const Query<const Turn, Rotation>& query) {
    query.chunks([](ChunkView chunk, std::span<const Turn> turns, std::span<Rotation> rotations) {
        const std::uint32_t size = chunk.size();
        for (std::uint32_t i = 0; i < size; ++i) {
            Rotation& r = rotations[i];
            turn_one(r.x, r.y, r.z, r.w, turns[i].x, turns[i].y, turns[i].z);
        }
    });
}

/// __restrict: seven arrays are too many for the compiler's run-time alias checks. Not inlined,
/// since g++ 12 then loses __restrict and leaves the loop scalar.
[[gnu::noinline]] inline void turn_lanes(
    std::size_t size, float* __restrict x, float* __restrict y, float* __restrict z,
    float* __restrict w, const float* __restrict tx, const float* __restrict ty,
    const float* __restrict tz) {
    for (std::size_t i = 0; i < size; ++i) {
        turn_one(x[i], y[i], z[i], w[i], tx[i], ty[i], tz[i]);
    }
}

[[gnu::noinline]] inline void turn_split(const Query<const SplitTurn, SplitRotation>& query) {
    query.chunks(
        [](ChunkView chunk, SplitSpan<const SplitTurn> turns, SplitSpan<SplitRotation> rotations) {
            turn_lanes(
                chunk.size(), rotations.lane(0).data(), rotations.lane(1).data(),
                rotations.lane(2).data(), rotations.lane(3).data(), turns.lane(0).data(),
                turns.lane(1).data(), turns.lane(2).data());
        });
}

struct KindTimes {
    Timing table;
    Timing split;
    Timing raw;
};

/// Adds the rows of a split component and of the same in a table, relative to raw arrays.
inline void split_rows(Bench& bench, const char* name, std::size_t count, const KindTimes& times) {
    bench.add(
        {0,
         fmt::format("{}, split", name),
         count,
         "ns",
         times.split,
         times.raw,
         {},
         Figure::OfRaw,
         0,
         ""});
    bench.add(
        {0,
         fmt::format("{}, table", name),
         count,
         "ns",
         times.table,
         times.raw,
         {},
         Figure::OfRaw,
         0,
         ""});
}

inline void split(Bench& bench) {
    for (const std::size_t count : {kCached, kMany}) {
        World world;
        const std::vector<Entity> table = fill<Sphere, Visible, Turn, Rotation>(world, count);
        World split_world;
        const std::vector<Entity> lanes =
            split_world.create_many(count, SplitSphere{}, Visible{}, SplitTurn{}, SplitRotation{});
        for (std::size_t i = 0; i < count; ++i) {
            SplitSphere sphere;
            SplitTurn turn;
            SplitRotation rotation;
            start(sphere, i);
            start(turn, i);
            start(rotation, i);
            split_world.set(lanes[i], sphere);
            split_world.set(lanes[i], turn);
            split_world.set(lanes[i], rotation);
        }
        const RawArrays<Visible> raw_visible(count);
        std::vector<RawColumn<float>> raw;
        for (std::size_t lane = 0; lane < 11; ++lane) {
            raw.emplace_back(count, lane);
        }
        for (std::size_t i = 0; i < count; ++i) {
            for (std::uint32_t lane = 0; lane < 3; ++lane) {
                raw[lane].data()[i] = noise(i, lane);
                raw[8 + lane].data()[i] = noise(i, 7 + lane);
            }
            raw[3].data()[i] = 0.1f;
            raw[4].data()[i] = noise(i, 6);
            raw[7].data()[i] = 1;
        }
        const auto cull_query = world.query<const Sphere, Visible>();
        const auto turn_query = world.query<const Turn, Rotation>();
        const auto split_cull_query = split_world.query<const SplitSphere, Visible>();
        const auto split_turn_query = split_world.query<const SplitTurn, SplitRotation>();
        const auto timed = [&](auto&& once) {
            return per(time_of_rounds(rounds_for(count), once), count);
        };
        const auto times = take_turns(
            bench.repeats, [&] { return timed([&] { cull_table(cull_query); }); },
            [&] { return timed([&] { cull_split(split_cull_query); }); },
            [&] {
                return timed([&] {
                    cull_lanes(
                        count, raw[0].data(), raw[1].data(), raw[2].data(), raw[3].data(),
                        raw_visible.column<Visible>());
                });
            },
            [&] { return timed([&] { turn_table(turn_query); }); },
            [&] { return timed([&] { turn_split(split_turn_query); }); },
            [&] {
                return timed([&] {
                    turn_lanes(
                        count, raw[4].data(), raw[5].data(), raw[6].data(), raw[7].data(),
                        raw[8].data(), raw[9].data(), raw[10].data());
                });
            });
        split_rows(bench, "frustum cull", count, {times[0], times[1], times[2]});
        split_rows(bench, "turn and normalize", count, {times[3], times[4], times[5]});
        std::size_t different = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Rotation rotation = world.get<const Rotation>(table[i]);
            const SplitRotation turned = split_world.value<SplitRotation>(lanes[i]);
            const bool visible = raw_visible.column<Visible>()[i].yes == 1;
            different += rotation.x != turned.x || rotation.w != turned.w
                         || turned.x != raw[4].data()[i] || turned.w != raw[7].data()[i]
                         || (world.get<const Visible>(table[i]).yes == 1) != visible
                         || (split_world.get<const Visible>(lanes[i]).yes == 1) != visible;
        }
        bench.check(different == 0, "split");
    }
}

}  // namespace limn::bench
