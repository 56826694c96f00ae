#include "ecs/base/rng.h"
#include "systems/particles/particle_collision.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace limn::particle_collision_batch_test {

using namespace limn::test;

namespace {

constexpr float kStep = 1.0f / 60.0f;

/// Arrays of particles and the step that they are about to make.
struct Swarm {
    std::vector<float> x0, y0, z0, x, y, z, vx, vy, vz, radius;
    std::vector<std::uint8_t> marks;

    void add(const Vec3& from, const Vec3& velocity, float size = 0, float dt = kStep) {
        const Vec3 to = from + velocity * dt;
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<float>* const starts[] = {&x0, &y0, &z0};
            std::vector<float>* const ends[] = {&x, &y, &z};
            std::vector<float>* const speeds[] = {&vx, &vy, &vz};
            starts[axis]->push_back(from[axis]);
            ends[axis]->push_back(to[axis]);
            speeds[axis]->push_back(velocity[axis]);
        }
        radius.push_back(size);
        marks.push_back(0);
    }
    CollidingParticles part(std::size_t first, std::size_t count) {
        const auto in = [&](std::vector<float>& all) {
            return std::span(all).subspan(first, count);
        };
        return {
            .x0 = in(x0),
            .y0 = in(y0),
            .z0 = in(z0),
            .x = in(x),
            .y = in(y),
            .z = in(z),
            .vx = in(vx),
            .vy = in(vy),
            .vz = in(vz),
            .radius = in(radius),
            .marks = std::span(marks).subspan(first, count),
            .first = static_cast<std::uint32_t>(first)};
    }
    CollidingParticles all() { return part(0, x.size()); }
    ParticlePaths paths() {
        return {
            .x0 = x0,
            .y0 = y0,
            .z0 = z0,
            .x1 = x,
            .y1 = y,
            .z1 = z,
            .radius = radius,
            .skin = 1e-4f};
    }
    Vec3 from(std::size_t i) const { return {x0[i], y0[i], z0[i]}; }
    Vec3 to(std::size_t i) const { return {x[i], y[i], z[i]}; }
    Vec3 velocity(std::size_t i) const { return {vx[i], vy[i], vz[i]}; }

    bool operator==(const Swarm&) const = default;
};

Vec3 random_vector(Random& random, float size) {
    return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// `spread` from the origin, at up to `speed`.
Swarm make_swarm(std::size_t count, float spread, float speed, float size) {
    Random random(8, 7, 6, 5);
    Swarm swarm;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 from = random_vector(random, spread);
        swarm.add(from, random_vector(random, speed), random.uniform(0.0f, size));
    }
    return swarm;
}

/// One collider of each kind, none far from the origin.
struct Scene {
    std::vector<float> heights;
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    MeshBvh bvh;
    std::vector<Collider> colliders;

    Scene() {
        Random random(1, 1, 2, 3);
        for (int i = 0; i < 400; ++i) {
            heights.push_back(random.uniform(-3.0f, -1.5f));
        }
        for (std::uint32_t i = 0; i < 60; ++i) {
            const Vec3 center = random_vector(random, 3);
            for (std::uint32_t corner = 0; corner < 3; ++corner) {
                positions.push_back(center + random_vector(random, 0.5f));
                indices.push_back(3 * i + corner);
            }
        }
        bvh = build_mesh_bvh(positions, indices);
        const Mat4 turn = glm::rotate(Mat4(1), 0.6f, glm::normalize(Vec3(1, 2, 3)));
        colliders = {
            PlaneCollider{.normal = {0.1f, 1, 0.2f}, .offset = -2},
            SphereCollider{.center = {1, 0, 0.5f}, .radius = 0.7f},
            SphereCollider{.center = {0.3f, 0, 0}, .radius = 4, .inverted = true},
            BoxCollider{
                .world_from_box = to_affine(glm::translate(Mat4(1), Vec3(-1.5f, 0.5f, 0)) * turn),
                .half = {0.8f, 0.2f, 0.5f}},
            HeightCollider{
                .origin = {-4, 0, -4},
                .cell = {0.4f, 0.4f},
                .width = 20,
                .depth = 20,
                .heights = heights},
            MeshCollider{.bvh = &bvh}};
    }
    ColliderSet set() const {
        ColliderSet made;
        set_colliders(made, colliders);
        return made;
    }
};

bool same_bits(const std::vector<ParticleHit>& a, const std::vector<ParticleHit>& b) {
    return a.size() == b.size()
           && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(ParticleHit)) == 0);
}

}  // namespace

TEST_CASE("particle collision: a batch moves each particle as if it were alone") {
    const Scene scene;
    const SurfaceResponse response = {.bounce = 0.6f, .friction = 0.9f};
    Swarm swarm = make_swarm(4000, 3, 60, 0.05f);
    const Swarm before = swarm;
    std::vector<ParticleHit> hits;
    collide_particles(swarm.all(), kStep, scene.set(), response, {}, hits);
    int moved = 0;
    for (std::size_t i = 0; i < swarm.x.size(); ++i) {
        const CollisionResult alone = move_with_collisions(
            before.from(i), before.velocity(i), kStep, scene.colliders, response,
            {.radius = before.radius[i]});
        CHECK(swarm.to(i) == alone.position);
        CHECK(swarm.velocity(i) == alone.velocity);
        moved += alone.contacts > 0 ? 1 : 0;
    }
    CHECK(moved > 500);
}

TEST_CASE("particle collision: without contact the end of the path is kept to the bit") {
    const Scene scene;
    Swarm swarm = make_swarm(4000, 3, 5, 0);
    for (float& y : swarm.y) {
        y += 1e-3f;  // not where the velocity leads
    }
    const Swarm before = swarm;
    std::vector<ParticleHit> hits;
    collide_particles(swarm.all(), kStep, scene.set(), {}, {}, hits);
    int unmoved = 0;
    for (std::size_t i = 0; i < swarm.x.size(); ++i) {
        bool clear = true;
        for (const Collider& collider : scene.colliders) {
            clear = clear && !first_contact(collider, before.from(i), before.to(i), 2e-4f)
                    && !find_escape(collider, before.from(i), 2e-4f);
        }
        if (clear) {
            ++unmoved;
            CHECK(swarm.to(i) == before.to(i));
            CHECK(swarm.velocity(i) == before.velocity(i));
            CHECK(swarm.marks[i] == 0);
        }
    }
    CHECK(unmoved > 2000);
}

TEST_CASE("particle collision: the quick test misses no contact and no particle inside") {
    const Scene scene;
    const ColliderSet set = scene.set();
    for (const float speed : {1.0f, 20.0f, 200.0f}) {
        Swarm swarm = make_swarm(5000, 5, speed, 0.2f);
        for (std::size_t c = 0; c < set.colliders.size(); ++c) {
            CAPTURE(c);
            std::vector<std::uint32_t> found(swarm.x.size() + kCandidatePadding);
            const std::size_t count = find_near(
                swarm.paths(), 0, swarm.x.size(), std::span(set.bounds).subspan(c, 1),
                found.data());
            std::vector<bool> near(swarm.x.size());
            for (std::size_t i = 0; i < count; ++i) {
                near[found[i]] = true;
            }
            for (std::size_t i = 0; i < swarm.x.size(); ++i) {
                const float radius = swarm.radius[i];
                const bool touches =
                    first_contact(set.colliders[c], swarm.from(i), swarm.to(i), radius)
                    || find_escape(set.colliders[c], swarm.from(i), radius);
                if (touches) {
                    CHECK(near[i]);
                }
            }
            CHECK(count > 0);
            if (speed < 10 && !std::holds_alternative<HeightCollider>(set.colliders[c])) {
                CHECK(count < swarm.x.size() * 9 / 10);  // it does leave some out
            }
        }
    }
}

TEST_CASE("particle collision: the quick test knows how far a ball looks along a mesh") {
    const Vec3 positions[] = {{0, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    const std::uint32_t indices[] = {0, 1, 2};
    const MeshBvh bvh = build_mesh_bvh(positions, indices);
    const Collider mesh = MeshCollider{.bvh = &bvh};
    const ColliderBounds bounds = find_collider_bounds(mesh);
    Swarm swarm;
    const Vec3 path = {0.95f, -0.31f, 0};
    swarm.add(Vec3(0.1f, 0, 0) - 1.6f * path, path, 0.2f, 1);  // ends 0.6 m before the triangle
    REQUIRE(first_contact(mesh, swarm.from(0), swarm.to(0), 0.2f));
    std::vector<std::uint32_t> found(1 + kCandidatePadding);
    CHECK(find_near(swarm.paths(), 0, 1, {&bounds, 1}, found.data()) == 1);
}

TEST_CASE("particle collision: particles over the low parts of a height field are left out") {
    std::vector<float> ramp;
    for (int i = 0; i < 11 * 11; ++i) {
        ramp.push_back(0.1f * static_cast<float>(i % 11));
    }
    const Collider field = HeightCollider{.width = 11, .depth = 11, .heights = ramp};
    const ColliderBounds bounds = find_collider_bounds(field);
    Swarm swarm;
    for (int i = 0; i < 20; ++i) {  // the surface is at 0.2 there and rises to 1
        swarm.add({2, i == 7 ? 0.21f : 0.5f, 5}, {2, -2, 2});
    }
    std::vector<std::uint32_t> found(swarm.x.size() + kCandidatePadding);
    CHECK(find_near(swarm.paths(), 0, 20, {&bounds, 1}, found.data()) == 1);
    CHECK(found[0] == 7);
    CHECK(find_near_scalar(swarm.paths(), 0, 20, {&bounds, 1}, found.data()) == 1);
}

TEST_CASE("particle collision: the quick test is the same on every vector width") {
    const Scene scene;
    const ColliderSet set = scene.set();
    Swarm swarm = make_swarm(1003, 6, 100, 0.1f);
    swarm.x[17] = std::numeric_limits<float>::quiet_NaN();
    swarm.y0[18] = std::numeric_limits<float>::infinity();
    std::vector<std::uint32_t> a(swarm.x.size() + kCandidatePadding);
    std::vector<std::uint32_t> b(swarm.x.size() + kCandidatePadding);
    for (std::size_t c = 0; c < set.bounds.size(); ++c) {
        for (const std::size_t size : {std::size_t{1}, set.bounds.size() - c}) {
            const std::span<const ColliderBounds> bounds = std::span(set.bounds).subspan(c, size);
            const std::size_t expected = find_near_scalar(swarm.paths(), 3, 1000, bounds, b.data());
            CHECK(std::find(b.begin(), b.end(), 17u) != b.end());
            CHECK(std::find(b.begin(), b.end(), 18u) != b.end());
            for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                CHECK(find_near(swarm.paths(), 3, 1000, bounds, a.data()) == expected);
                const auto end = a.begin() + static_cast<std::ptrdiff_t>(expected);
                CHECK(std::equal(a.begin(), end, b.begin()));
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST_CASE("particle collision: how a range is cut in blocks does not change a bit") {
    const Scene scene;
    const ColliderSet set = scene.set();
    const Swarm begin = make_swarm(5000, 3, 60, 0.05f);
    Swarm whole = begin;
    std::vector<ParticleHit> hits;
    collide_particles(whole.all(), kStep, set, {}, {}, hits);
    CHECK(hits.size() > 500);
    for (const std::size_t block : {std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
        Swarm cut = begin;
        std::vector<ParticleHit> cut_hits;
        for (std::size_t first = 0; first < cut.x.size(); first += block) {
            collide_particles(
                cut.part(first, std::min(block, cut.x.size() - first)), kStep, set, {}, {},
                cut_hits);
        }
        CHECK(cut == whole);
        CHECK(same_bits(hits, cut_hits));
    }
}

TEST_CASE("particle collision: hits hold particle, collider, position and velocity, in order") {
    const Collider floor[] = {SphereCollider{.center = {50, 0, 0}}, PlaneCollider{}};
    ColliderSet set;
    set_colliders(set, floor);
    Swarm swarm;
    swarm.add({0, 1, 0}, {1, -2, 0}, 0, 1);         // hits
    swarm.add({0, 3, 0}, {1, -2, 0}, 0, 1);         // does not
    swarm.add({0, 0.05f, 0}, {1, -0.1f, 0}, 0, 1);  // touches too slowly
    swarm.add({5, 2, 0}, {0, -4, 0}, 0.5f, 1);
    std::vector<ParticleHit> hits;
    collide_particles(swarm.all(), 1, set, {.bounce = 1, .friction = 1}, {.skin = 1e-6f}, hits);
    REQUIRE(hits.size() == 2);
    CHECK(hits[0].particle == 0);
    CHECK(hits[0].collider == 1);
    CHECK(double{hits[0].point.x} == near(0.5));
    CHECK(double{hits[0].point.y} == near(0).scale(1));
    CHECK(hits[0].normal == Vec3(0, 1, 0));
    CHECK(hits[0].velocity == Vec3(1, -2, 0));
    CHECK(hits[1].particle == 3);
    CHECK(double{hits[1].point.y} == near(0.5));
    CHECK(swarm.marks == std::vector<std::uint8_t>{kParticleHit, 0, 0, kParticleHit});
}

TEST_CASE("particle collision: sticking particles stay where they have hit") {
    const Collider floor = PlaneCollider{};
    ColliderSet set;
    set_colliders(set, {&floor, 1});
    const CollisionOptions options = {.action = ContactAction::Stick};
    Swarm swarm;
    swarm.add({0, 1, 0}, {1, -2, 0}, 0, 1);
    std::vector<ParticleHit> hits;
    collide_particles(swarm.all(), 1, set, {}, options, hits);
    CHECK(swarm.marks[0] == (kParticleHit | kParticleStuck));
    CHECK(swarm.velocity(0) == Vec3(0));
    CHECK(double{swarm.x[0]} == near(0.5).epsilon(1e-4));
    CHECK(double{swarm.y[0]} == near(0).scale(1).epsilon(2e-4));

    // Gravity pulls in the next step, in vain.
    const Vec3 stuck = swarm.to(0);
    const std::uint8_t mark = swarm.marks[0];
    swarm = {};
    swarm.add(stuck, {0, -9, 0}, 0, 1);
    swarm.marks[0] = mark;
    hits.clear();
    collide_particles(swarm.all(), 1, set, {}, options, hits);
    CHECK(swarm.to(0) == stuck);
    CHECK(swarm.velocity(0) == Vec3(0));
    CHECK(swarm.marks[0] == kParticleStuck);
    CHECK(hits.empty());
}

TEST_CASE("particle collision: killed particles are marked and have one hit") {
    const Collider walls[] = {PlaneCollider{}, PlaneCollider{.normal = {-1, 0, 0}, .offset = -1}};
    ColliderSet set;
    set_colliders(set, walls);
    Swarm swarm;
    swarm.add({0, 0.5f, 0}, {2, -1, 0}, 0, 1);
    swarm.add({0, 5, 0}, {0.5f, -1, 0}, 0, 1);
    swarm.add({0, -2, 0}, {0, -1, 0}, 0, 1);  // starts inside
    std::vector<ParticleHit> hits;
    collide_particles(swarm.all(), 1, set, {}, {.action = ContactAction::Kill}, hits);
    CHECK(swarm.marks[0] == (kParticleHit | kParticleKilled));
    CHECK(swarm.marks[1] == 0);
    CHECK(swarm.marks[2] == (kParticleHit | kParticleKilled));
    REQUIRE(hits.size() == 2);
    CHECK(hits[0].particle == 0);
    CHECK(hits[1].particle == 2);
    CHECK(hits[1].velocity == Vec3(0, -1, 0));
}

TEST_CASE("particle collision: one radius serves all where none is given for each") {
    const Collider floor = PlaneCollider{};
    ColliderSet set;
    set_colliders(set, {&floor, 1});
    Swarm swarm;
    for (int i = 0; i < 20; ++i) {
        swarm.add({static_cast<float>(i), 1, 0}, {0, -2, 0}, 0, 1);
    }
    CollidingParticles particles = swarm.all();
    particles.radius = {};
    std::vector<ParticleHit> hits;
    collide_particles(particles, 1, set, {.bounce = 0, .friction = 1}, {.radius = 0.25f}, hits);
    CHECK(hits.size() == 20);
    for (const float y : swarm.y) {
        CHECK(double{y} == near(0.25).epsilon(1e-3));
    }
}

TEST_CASE("particle collision: a batch allocates nothing when there is room for its hits") {
    const Scene scene;
    Swarm swarm = make_swarm(1000, 3, 60, 0);
    std::vector<ParticleHit> hits;
    hits.reserve(20000);
    const ParticleHit* const memory = hits.data();
    collide_particles(swarm.all(), kStep, scene.set(), {}, {}, hits);
    CHECK(!hits.empty());
    CHECK(hits.data() == memory);
}

TEST_CASE("particle collision: a batch stops what is not finite, other particles go on") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Collider floor = PlaneCollider{.offset = -100};
    ColliderSet set;
    set_colliders(set, {&floor, 1});
    Swarm swarm;
    for (int i = 0; i < 20; ++i) {
        swarm.add({static_cast<float>(i), 1, 0}, {0, i == 5 ? nan : 1, 0}, 0, 1);
    }
    std::vector<ParticleHit> hits;
    collide_particles(swarm.all(), 1, set, {}, {}, hits);
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(swarm.y[i] == (i == 5 ? 1.0f : 2.0f));
        CHECK(swarm.vy[i] == (i == 5 ? 0.0f : 1.0f));
    }
}

}  // namespace limn::particle_collision_batch_test
