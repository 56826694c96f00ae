#include "bench/particles/particle_race.h"
#include "bench/particles/particle_rows.h"
#include "bench/particles/scalar_bvh.h"
#include "ecs/base/rng.h"
#include "systems/particles/mesh_bvh.h"
#include "systems/particles/particle_collision.h"
#include "systems/particles/particle_collision_kernels.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

// Collision and tracing of particles against what people write by hand.

namespace limn::bench {
namespace {

constexpr std::size_t kMany = 1000000;

// ---- colliding
// -----------------------------------------------------------------------------------

struct Body {
    Vec3 position;
    Vec3 velocity;
    float rest[12];  ///< age, color, size and so on
};
static_assert(sizeof(Body) == 72);

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

void collide_structures(std::vector<Body>& all, const PlaneCollider& plane) {
    for (Body& p : all) {
        const float distance = glm::dot(p.position, plane.normal) - plane.offset;
        if (distance < 0) {
            p.position -= distance * plane.normal;
            respond_by_hand(p.velocity, plane.normal);
        }
    }
}

void collide_structures(std::vector<Body>& all, const SphereCollider& sphere) {
    const float radius2 = sphere.radius * sphere.radius;
    for (Body& p : all) {
        const Vec3 delta = p.position - sphere.center;
        const float length2 = glm::dot(delta, delta);
        if (length2 < radius2) {
            const Vec3 normal = delta / std::sqrt(length2);
            p.position = sphere.center + sphere.radius * normal;
            respond_by_hand(p.velocity, normal);
        }
    }
}

void collide_structures(std::vector<Body>& all, const HeightCollider& field) {
    const Vec2 per_meter = 1.0f / field.cell;
    for (Body& p : all) {
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
void add_collision_row(
    ParticleBench& bench, const char* name, const Shape& shape, float floor, Kernel kernel,
    double gate) {
    Arrays arrays;
    std::vector<Body> structures(kMany);
    Random random(1, 2, 3, 4);
    for (std::size_t i = 0; i < kMany; ++i) {
        Body& p = structures[i];
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
    const std::vector<Body> first_structures = structures;
    const auto [ours, by_hand] = race(
        kMany, [&] { arrays = first_arrays; },
        [&] { kernel(arrays.columns(), shape, kResponse, 0.0f); },
        [&] { structures = first_structures; }, [&] { collide_structures(structures, shape); });
    bench.add(GateRow{"13", name, ours, by_hand, "structures", "ns", gate});
}

void add_shape_rows(ParticleBench& bench) {
    add_collision_row(
        bench, "plane, 1M", PlaneCollider{.offset = -9.8f}, -10.0f, collide_plane, 0.45);
    add_collision_row(
        bench, "sphere, 1M", SphereCollider{.radius = 2.7f}, -10.0f, collide_sphere, 0.35);
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
    add_collision_row(
        bench, "height field of 512 x 512, 1M", field, -10.0f, collide_height_field, 0.3);
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

/// Of 0.3 to 1 m, from positions up to `spread` above or below the hills.
std::vector<Segment> make_segments(std::size_t count, float spread) {
    Random random(5, 6, 7, 8);
    std::vector<Segment> segments(count);
    for (Segment& segment : segments) {
        const float x = random.uniform(-24.0f, 24.0f);
        const float z = random.uniform(-24.0f, 24.0f);
        segment.from = {x, Hills::height(x, z) + random.uniform(-spread, spread), z};
        const Vec3 direction(
            random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f), random.uniform(-1.0f, 1.0f));
        segment.to =
            segment.from + random.uniform(0.3f, 1.0f) * normalize_or(direction, Vec3(0, 1, 0));
    }
    return segments;
}

void add_tracing_rows(ParticleBench& bench) {
    constexpr std::size_t kSegments = 200000;
    const Hills hills;
    const MeshBvh bvh = build_mesh_bvh(hills.positions, hills.indices);
    const ScalarBvh scalar(hills.positions, hills.indices);
    std::vector<MeshHit> hits(kSegments);
    std::vector<float> fractions(kSegments);
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
                fractions[i] = scalar.first_hit_fraction(segments[i]);
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
        const auto [ours, plain] = race(
            kSegments, kUnprepared, one_by_one(row.segments), kUnprepared, by_hand(row.segments));
        bench.add(GateRow{
            "14", std::string("segments ") + row.name, ours, plain, "scalar BVH by hand", "ns",
            0.6});
        std::size_t differ = 0;
        for (std::size_t i = 0; i < kSegments; ++i) {
            differ += (hits[i].triangle != kNoTriangle) == (fractions[i] <= 1) ? 0 : 1;
        }
        bench.note(fmt::format("of {} segments, {} were decided otherwise", kSegments, differ));
    }
    const auto batched = [&] { first_hits(bvh, near, hits, batch); };
    const auto [sorted, plain] = race(kSegments, kUnprepared, batched, kUnprepared, by_hand(near));
    bench.add(GateRow{
        "14", "segments near the surface, sorted batch", sorted, plain, "scalar BVH by hand", "ns",
        0.6});
    const auto [morton, random] =
        race(kSegments, kUnprepared, one_by_one(ordered), kUnprepared, one_by_one(near));
    bench.add(
        GateRow{"15", "segments in Morton order", morton, random, "random order", "ns", 0.75});
    const auto [batch_time, single] =
        race(kSegments, kUnprepared, batched, kUnprepared, one_by_one(near));
    bench.add(
        GateRow{"15", "segments, sorted batch", batch_time, single, "random order", "ns", 0.75});
}

}  // namespace

void add_collision_rows(ParticleBench& bench) {
    add_shape_rows(bench);
    add_tracing_rows(bench);
}

}  // namespace limn::bench
