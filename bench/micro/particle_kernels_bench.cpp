#include "bench/micro/scalar_bvh.h"
#include "ecs/base/depth_sort.h"
#include "ecs/base/rng.h"
#include "systems/particles/mesh_bvh.h"
#include "systems/particles/particle_collision.h"
#include "systems/particles/particle_collision_kernels.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <string>
#include <vector>

// Sorting, collision and tracing of particles against what people write by hand. Prints the ratio
// of the times, the gate that it has to stay below, and "pass" or "miss". Both take turns, and of
// each the best run counts, so that other work on the machine disturbs little; this file is
// compiled with the flags that suit the loops to compare with best (-O3 -march=native).

namespace {

using namespace limn;

constexpr std::size_t kMany = 1000000;
constexpr int kRepeats = 15;

/// Best times of two functions, in turns, each after its untimed preparation [s].
template <typename PrepareA, typename A, typename PrepareB, typename B>
std::pair<double, double> race(PrepareA prepare_a, A a, PrepareB prepare_b, B b) {
    using Clock = std::chrono::steady_clock;
    const auto time = [](auto& prepare, auto& run) {
        prepare();
        const auto begin = Clock::now();
        run();
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    std::pair<double, double> best = {INFINITY, INFINITY};
    for (int i = 0; i < kRepeats; ++i) {
        best.first = std::min(best.first, time(prepare_a, a));
        best.second = std::min(best.second, time(prepare_b, b));
    }
    return best;
}

/// `count` items in each time.
void print_row(
    const char* number, const std::string& name, std::pair<double, double> times, std::size_t count,
    double gate) {
    const double ratio = times.first / times.second;
    const double per_item = 1e9 / static_cast<double>(count);
    std::printf(
        "%-3s %-44s %8.2f ns %8.2f ns   ratio %.3f   gate %.2f   %s\n", number, name.c_str(),
        times.first * per_item, times.second * per_item, ratio, gate,
        ratio <= gate ? "pass" : "miss");
    std::fflush(stdout);
}

// ---- sorting
// -----------------------------------------------------------------------------------

template <typename Key>
void sort_row(
    const char* number, const char* name, std::size_t count, SortThreads threads, double gate) {
    Random random(1, 2, 3, 4);
    std::vector<Key> keys(count);
    std::vector<std::uint64_t> packed(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t word = depth_key(-random.uniform(0.1f, 1000.0f));
        keys[i] = static_cast<Key>(sizeof(Key) == 2 ? random.word() >> 16 : word);
        packed[i] = std::uint64_t{keys[i]} << 32 | i;
    }
    std::vector<std::uint32_t> order(count);
    std::vector<std::uint64_t> sorted(count);
    SortScratch scratch;
    const auto times = race(
        [&] { std::iota(order.begin(), order.end(), 0u); },
        [&] { sort_by_depth(std::span<const Key>(keys), order, scratch, threads); },
        [&] { sorted = packed; }, [&] { std::sort(sorted.begin(), sorted.end()); });
    print_row(number, name, times, count, gate);
}

// ---- colliding
// -----------------------------------------------------------------------------------

struct Structure {
    Vec3 position;
    Vec3 velocity;
    float rest[12];  ///< age, color, size and so on
};
static_assert(sizeof(Structure) == 72);

struct Arrays {
    std::vector<float> column[6];

    ParticleColumns columns() {
        return {column[0], column[1], column[2], column[3], column[4], column[5]};
    }
};

constexpr SurfaceResponse kResponse = {.bounce = 0.5f, .friction = 0.9f};

void respond_by_hand(Vec3& velocity, const Vec3& normal) {
    const float speed = glm::dot(velocity, normal);
    if (speed < 0) {
        velocity =
            kResponse.friction * (velocity - speed * normal) - kResponse.bounce * speed * normal;
    }
}

void collide_structures(std::vector<Structure>& all, const PlaneCollider& plane) {
    for (Structure& p : all) {
        const float distance = glm::dot(p.position, plane.normal) - plane.offset;
        if (distance < 0) {
            p.position -= distance * plane.normal;
            respond_by_hand(p.velocity, plane.normal);
        }
    }
}

void collide_structures(std::vector<Structure>& all, const SphereCollider& sphere) {
    const float radius2 = sphere.radius * sphere.radius;
    for (Structure& p : all) {
        const Vec3 delta = p.position - sphere.center;
        const float length2 = glm::dot(delta, delta);
        if (length2 < radius2) {
            const Vec3 normal = delta / std::sqrt(length2);
            p.position = sphere.center + sphere.radius * normal;
            respond_by_hand(p.velocity, normal);
        }
    }
}

void collide_structures(std::vector<Structure>& all, const HeightCollider& field) {
    const Vec2 per_meter = 1.0f / field.cell;
    for (Structure& p : all) {
        const float x = (p.position.x - field.origin.x) * per_meter.x;
        const float z = (p.position.z - field.origin.z) * per_meter.y;
        if (!(x >= 0 && z >= 0 && x <= static_cast<float>(field.width - 1)
              && z <= static_cast<float>(field.depth - 1))) {
            continue;
        }
        const int i = std::min(static_cast<int>(x), field.width - 2);
        const int j = std::min(static_cast<int>(z), field.depth - 2);
        const float fx = x - static_cast<float>(i);
        const float fz = z - static_cast<float>(j);
        const float* const h = field.heights.data() + j * field.width + i;
        const float back = h[0] + (h[1] - h[0]) * fx;
        const float front = h[field.width] + (h[field.width + 1] - h[field.width]) * fx;
        const float surface = field.origin.y + back + (front - back) * fz;
        if (p.position.y < surface) {
            p.position.y = surface;
            const float slope_x =
                (h[1] - h[0]) * (1 - fz) + (h[field.width + 1] - h[field.width]) * fz;
            const Vec3 normal =
                glm::normalize(Vec3(-slope_x * per_meter.x, 1, -(front - back) * per_meter.y));
            respond_by_hand(p.velocity, normal);
        }
    }
}

/// A million particles in a cube of 20 m, of which one in a hundred is inside.
template <typename Shape, typename Kernel>
void collision_row(const char* name, const Shape& shape, float floor, Kernel kernel, double gate) {
    Arrays arrays;
    std::vector<Structure> structures(kMany);
    Random random(1, 2, 3, 4);
    for (std::size_t i = 0; i < kMany; ++i) {
        Structure& p = structures[i];
        p = {};
        p.position = {
            random.uniform(-10.0f, 10.0f), random.uniform(floor, 10.0f),
            random.uniform(-10.0f, 10.0f)};
        for (int axis = 0; axis < 3; ++axis) {
            p.velocity[axis] = random.uniform(-10.0f, 10.0f);
            arrays.column[axis].push_back(p.position[axis]);
            arrays.column[3 + axis].push_back(p.velocity[axis]);
        }
    }
    const Arrays first_arrays = arrays;
    const std::vector<Structure> first_structures = structures;
    const auto times = race(
        [&] { arrays = first_arrays; }, [&] { kernel(arrays.columns(), shape, kResponse, 0.0f); },
        [&] { structures = first_structures; }, [&] { collide_structures(structures, shape); });
    print_row("13", name, times, kMany, gate);
}

void collision_rows() {
    collision_row("plane, 1M", PlaneCollider{.offset = -9.8f}, -10.0f, collide_plane, 0.45);
    collision_row("sphere, 1M", SphereCollider{.radius = 2.7f}, -10.0f, collide_sphere, 0.35);
    constexpr int kPoints = 512;
    std::vector<float> heights(kPoints * kPoints);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const auto x = static_cast<float>(i % kPoints);
        const auto z = static_cast<float>(i / kPoints);
        heights[i] = 0.1f * std::sin(0.05f * x) + 0.1f * std::sin(0.07f * z);
    }
    const float cell = 20.0f / (kPoints - 1);
    const HeightCollider field = {
        .origin = {-10, -9.8f, -10},
        .cell = {cell, cell},
        .width = kPoints,
        .depth = kPoints,
        .heights = heights};
    collision_row("height field of 512 x 512, 1M", field, -10.0f, collide_height_field, 0.3);
}

// ---- tracing
// -----------------------------------------------------------------------------------

/// 101,250 triangles of hills, 50 m wide.
struct Hills {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;

    static float height(float x, float z) {
        return 3 * std::sin(0.3f * x) * std::cos(0.25f * z) + 0.3f * std::sin(2 * x + z);
    }
    Hills() {
        constexpr std::uint32_t kCells = 225;
        for (std::uint32_t j = 0; j <= kCells; ++j) {
            for (std::uint32_t i = 0; i <= kCells; ++i) {
                const float x = 50.0f * static_cast<float>(i) / kCells - 25.0f;
                const float z = 50.0f * static_cast<float>(j) / kCells - 25.0f;
                positions.emplace_back(x, height(x, z), z);
            }
        }
        for (std::uint32_t j = 0; j < kCells; ++j) {
            for (std::uint32_t i = 0; i < kCells; ++i) {
                const std::uint32_t a = j * (kCells + 1) + i;
                const std::uint32_t b = a + kCells + 1;
                indices.insert(indices.end(), {a, b, a + 1, a + 1, b, b + 1});
            }
        }
    }
};

/// Of 0.3 to 1 m, from places up to `spread` above or below the hills.
std::vector<Segment> make_segments(std::size_t count, float spread) {
    Random random(5, 6, 7, 8);
    std::vector<Segment> segments(count);
    for (Segment& segment : segments) {
        const float x = random.uniform(-24.0f, 24.0f);
        const float z = random.uniform(-24.0f, 24.0f);
        segment.from = {x, Hills::height(x, z) + random.uniform(-spread, spread), z};
        const Vec3 way(
            random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f));
        segment.to = segment.from + random.uniform(0.3f, 1.0f) * normalize_or(way, Vec3(0, 1, 0));
    }
    return segments;
}

void tracing_rows() {
    constexpr std::size_t kSegments = 200000;
    const Hills hills;
    const MeshBvh bvh = build_mesh_bvh(hills.positions, hills.indices);
    const bench::ScalarBvh scalar(hills.positions, hills.indices);
    const auto nothing = [] {};
    std::vector<MeshHit> hits(kSegments);
    std::vector<float> shares(kSegments);
    SegmentBatch batch;
    const auto one_by_one = [&](const std::vector<Segment>& segments) {
        return [&] {
            for (std::size_t i = 0; i < segments.size(); ++i) {
                hits[i] = first_hit(bvh, segments[i]);
            }
        };
    };
    const auto by_hand = [&](const std::vector<Segment>& segments) {
        return [&] {
            for (std::size_t i = 0; i < segments.size(); ++i) {
                shares[i] = scalar.first_share(segments[i]);
            }
        };
    };
    const std::vector<Segment> near = make_segments(kSegments, 0.3f);
    const std::vector<Segment> volume = make_segments(kSegments, 6.0f);
    first_hits(bvh, near, hits, batch);
    std::vector<Segment> ordered;
    for (const std::uint32_t i : batch.order) {
        ordered.push_back(near[i]);
    }

    struct Row {
        const char* name;
        const std::vector<Segment>& segments;
    };
    for (const Row& row :
         {Row{"near the surface, random order", near},
          Row{"near the surface, Morton order", ordered},
          Row{"in a volume, random order", volume}}) {
        const auto times = race(nothing, one_by_one(row.segments), nothing, by_hand(row.segments));
        print_row("14", std::string("segments ") + row.name, times, kSegments, 0.6);
        std::size_t found = 0;
        std::size_t differ = 0;
        for (std::size_t i = 0; i < kSegments; ++i) {
            const bool hit = hits[i].triangle != kNoTriangle;
            found += hit ? 1 : 0;
            differ += hit == (shares[i] <= 1) ? 0 : 1;
        }
        std::printf(
            "      %.1f %% hit, %zu decided otherwise\n",
            100.0 * static_cast<double>(found) / static_cast<double>(kSegments), differ);
    }
    const auto batched = [&] { first_hits(bvh, near, hits, batch); };
    print_row(
        "14", "segments near the surface, sorted batch",
        race(nothing, batched, nothing, by_hand(near)), kSegments, 0.6);
    print_row(
        "15", "segments in Morton order / random order",
        race(nothing, one_by_one(ordered), nothing, one_by_one(near)), kSegments, 0.75);
    print_row(
        "15", "segments, sorted batch / random order",
        race(nothing, batched, nothing, one_by_one(near)), kSegments, 0.75);
}

}  // namespace

int main() {
    std::printf("    %-44s %11s %11s\n", "", "ours", "by hand");
    sort_row<std::uint32_t>("10", "sort 100k by 32 bits", 100000, SortThreads::One, 0.1);
    sort_row<std::uint32_t>("10", "sort 1M by 32 bits", kMany, SortThreads::One, 0.13);
    sort_row<std::uint16_t>("10", "sort 100k by 16 bits", 100000, SortThreads::One, 0.1);
    sort_row<std::uint16_t>("10", "sort 1M by 16 bits", kMany, SortThreads::One, 0.13);
    sort_row<std::uint32_t>("11", "sort 1M by 32 bits, all threads", kMany, SortThreads::All, 0.11);
    sort_row<std::uint16_t>("11", "sort 1M by 16 bits, all threads", kMany, SortThreads::All, 0.11);
    collision_rows();
    tracing_rows();
}
