#include "ecs/components/animation.h"
#include "ecs/components/height_field.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/water.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_waves.h"
#include "systems/particles/water_surface_hits.h"
#include "systems/water/water_query.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::particle_obstacles_test {

using namespace limn::test;

namespace {

/// A square of two triangles at y = 0 of 2 x 2 m, that a morph target raises by 1 m.
MeshData make_square() {
    MeshData mesh;
    mesh.positions = {{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}};
    mesh.normals.assign(4, Vec3(0, 1, 0));
    mesh.tangents.assign(4, Vec4(1, 0, 0, 1));
    mesh.uvs.assign(4, Vec2(0));
    mesh.indices = {0, 2, 1, 1, 2, 3};
    MorphTarget& up = mesh.morphs.emplace_back();
    up.vertices = {0, 1, 2, 3};
    up.positions.assign(4, Vec3(0, 1, 0));
    return mesh;
}

struct Obstacles : Emitters {
    /// Particles at 10 m/s straight down, without gravity, 5 m above the origin.
    Entity drop(const ParticleCollision& collision, float count = 100) {
        ParticleEmitter emitter = burst(count);
        emitter.shape = EmitterShape::Disc;
        emitter.size = {0.4f, 0, 0.4f};
        emitter.speed = -10;
        const Entity entity = add(emitter, falling(0));
        world.get<WorldTransform>(entity).world = affine_from({0, 5, 0}, Quat(1, 0, 0, 0), Vec3(1));
        world.get<PreviousWorldTransform>(entity).world =
            world.get<const WorldTransform>(entity).world;
        world.add(entity, collision);
        return entity;
    }
    Entity add_square(const Vec3& at, float scale = 1) {
        Assets& assets = world.resource<Assets>();
        assets.meshes.push_back(make_square());
        const auto index = static_cast<std::uint32_t>(assets.meshes.size() - 1);
        return world.create(
            ParticleCollider{.shape = ColliderShape::Mesh},
            MeshInstance{.mesh = {index}, .material = {}},
            WorldTransform{affine_from(at, Quat(1, 0, 0, 0), Vec3(scale))});
    }
    /// All of a pool are at this height.
    void check_height(double y, std::size_t which = 0, double tolerance = 1e-3) {
        const ParticlePool& all = pool(which);
        REQUIRE(all.size() == 100);
        for (const float height : all.y) {
            CHECK(height == near(y).epsilon(tolerance));
        }
    }
};

const ParticleCollision kStop = {.bounce = 0, .friction = 0, .radius = 0};

}  // namespace

/// Particles at 10 m/s toward a floor 2 m below them.
struct Bouncing : Emitters {
    explicit Bouncing(const ParticleCollision& collision, const ParticleCollider& collider = {}) {
        ParticleEmitter drop = burst(100);
        drop.speed = -10;
        drop.cone = 0.2f;
        world.add(add(drop), collision);
        world.create(collider, WorldTransform{affine_from({0, -2, 0}, Quat(1, 0, 0, 0), Vec3(1))});
    }
};

TEST_CASE("particle collision: on a floor they bounce ever lower, never pass it and come to rest") {
    Bouncing scene({.bounce = 0.5f, .friction = 1});
    float highest_late = -10;
    for (int step = 0; step < 600; ++step) {
        scene.run();
        const ParticlePool& pool = scene.pool();
        REQUIRE(pool.size() == 100);
        for (std::size_t i = 0; i < pool.size(); ++i) {
            REQUIRE(pool.y[i] > -2);
            highest_late = step > 500 ? std::max(highest_late, pool.y[i]) : highest_late;
        }
    }
    CHECK(highest_late < -1.98f);
    Emitters free;
    free.add(burst(1));
    free.run(200);
    CHECK(free.pool().y[0] < -10);  // without particle_collision nothing is in the way
}

TEST_CASE("particle collision: a box and a sphere stop them, scaled as their entities are") {
    for (const ColliderShape shape : {ColliderShape::Box, ColliderShape::Sphere}) {
        Bouncing scene(
            {.bounce = 0, .friction = 0, .radius = 0}, {.shape = shape, .size = Vec3(0.5f)});
        scene.world.query<const ParticleCollider, WorldTransform>().each(
            [](const ParticleCollider&, WorldTransform& transform) {
                transform.world = affine_from({0, -2, 0}, Quat(1, 0, 0, 0), {2, 3, 2});
            });
        scene.run(30);
        const ParticlePool& pool = scene.pool();
        for (std::size_t i = 0; i < pool.size(); ++i) {
            if (shape == ColliderShape::Box) {
                CHECK(pool.y[i] == test::near(-0.5).epsilon(1e-3));
            } else {
                CHECK(
                    glm::length(Vec3(pool.x[i], pool.y[i] + 2, pool.z[i]))
                    == test::near(1).epsilon(1e-3));
            }
        }
    }
}

TEST_CASE("particle collision: killed ones give birth once where they hit, along the normal") {
    Bouncing scene({.action = CollisionAction::Kill});
    ParticleEmitter splash = steady(0);
    splash.speed = 1;
    splash.cone = 0;
    scene.world.add(
        scene.add(splash, falling(0)),
        ParticleSource{
            .emitter = scene.entities[0], .at = ParticleMoment::Hit, .count = 3, .inherit = 0});
    scene.run(60);
    CHECK(scene.pool(0).size() == 0);
    const ParticlePool& pool = scene.pool(1);
    REQUIRE(pool.size() == 300);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        CHECK(pool.vy[i] == test::near(1));
        CHECK(pool.y[i] - pool.age[i] == test::near(-1.995).epsilon(1e-3));
    }
}

TEST_CASE(
    "particle obstacles: a mesh stops them where its entity has it, and where it moves to"
    * technique("particle.collision-loop")) {
    Obstacles scene;
    scene.drop(kStop);
    const Entity square = scene.add_square({0, 1, 0}, 3);
    scene.run(60);
    scene.check_height(1);
    scene.world.get<WorldTransform>(square).world =
        affine_from({0, 3, 0}, Quat(1, 0, 0, 0), Vec3(1));
    scene.drop(kStop);
    scene.run(60);
    scene.check_height(3, 1);
    CHECK(scene.world.resource<const ParticleObstacles>().meshes.size() == 1);

    // Edited in place: half as large and lower.
    MeshData& mesh = scene.world.resource<Assets>().meshes[0];
    for (Vec3& position : mesh.positions) {
        position = 0.5f * position - Vec3(0, 1, 0);
    }
    ++mesh.version;
    scene.drop(kStop);
    scene.run(60);
    scene.check_height(2, 2);

    scene.world.destroy(square);
    scene.drop(kStop);
    scene.run(60);
    CHECK(scene.pool(3).y[0] == near(5 - 10).epsilon(1e-3));
    CHECK(scene.world.resource<const ParticleObstacles>().meshes.empty());
}

TEST_CASE("particle obstacles: nothing passes a sheet of triangles at 60 m/s") {
    Obstacles scene;
    const Entity emitter = scene.drop({.bounce = 1, .friction = 1, .radius = 0}, 2000);
    ParticleEmitter& fast = scene.world.get<ParticleEmitter>(emitter);
    fast.speed = -60;
    fast.cone = 1.2f;
    scene.add_square({0, 1, 0}, 1000);
    scene.run(120);
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 2000);
    CHECK(*std::min_element(pool.y.begin(), pool.y.end()) > 1);
}

TEST_CASE(
    "particle obstacles: a deformed mesh stops them where it is deformed to"
    * technique("particle.collision-loop")) {
    Obstacles scene;
    scene.drop(kStop);
    const Entity square = scene.add_square({0, 1, 0}, 2);
    scene.world.add(square, Deformed{.character = square, .skin = {}});
    scene.world.add(square, MorphWeights{.weights = {0.75f}, .previous = {0.75f}});
    scene.run(60);
    scene.check_height(1 + 2 * 0.75);
    // A skin without joints: as it is at rest.
    scene.world.get<MorphWeights>(square).weights = {std::nanf("")};
    scene.drop(kStop);
    scene.run(60);
    scene.check_height(1, 1);
}

TEST_CASE(
    "particle obstacles: a height field holds them on its bilinear surface"
    * technique("particle.heightfield-collision")) {
    Obstacles scene;
    ParticleCollision grip = kStop;
    scene.drop(grip);
    HeightField field;
    field.points = 3;
    field.size = {8, 4};
    field.height = {0, 0.5f, 1, 0, 0.5f, 1, 0, 0.5f, 1};  // rises by 1/8 along x
    field.normal.assign(9, Vec3(0, 1, 0));
    const Entity land = scene.world.create(
        ParticleCollider{.shape = ColliderShape::HeightField}, field,
        WorldTransform{affine_from({0.5f, 1, 0}, Quat(1, 0, 0, 0), Vec3(1))});
    scene.run(60);
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 100);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        CHECK(pool.y[i] == near(1.5 + (pool.x[i] - 0.5) / 8).epsilon(1e-3));
    }
    // One that is turned is none.
    scene.world.get<WorldTransform>(land).world =
        affine_from({0.5f, 1, 0}, Quat(0.9f, 0, 0.43589f, 0), Vec3(1));
    scene.drop(grip);
    scene.run(60);
    CHECK(scene.pool(1).y[0] == near(-5).epsilon(1e-3));
}

TEST_CASE("particle obstacles: what sticks stays until its end") {
    Obstacles scene;
    const Entity emitter = scene.drop({.action = CollisionAction::Stick, .radius = 0});
    scene.world.get<ParticleMotion>(emitter).gravity = 1;
    ParticleEmitter& settings = scene.world.get<ParticleEmitter>(emitter);
    settings.life = 4;
    settings.life_spread = 1.5f;
    scene.add_square({0, 1, 0}, 1);
    scene.run(60);
    scene.check_height(1);
    const std::vector<float> x = scene.pool().x;
    scene.run(60);
    CHECK(scene.pool().x == x);
    scene.check_height(1);
    scene.run(60);  // some are dead
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() < 90);
    REQUIRE(pool.size() > 10);
    CHECK(pool.stuck == std::vector<std::uint32_t>(pool.size(), 1u));
    for (std::size_t i = 0; i < pool.size(); ++i) {
        CHECK(pool.y[i] == near(1).epsilon(1e-3));
        CHECK(std::find(x.begin(), x.end(), pool.x[i]) != x.end());
    }
}

namespace {

/// A pool of 6 x 6 m at y = 1 with ripples, and waves if asked.
struct Pond : Obstacles {
    Entity water;
    explicit Pond(float amplitude = 0, float ripple = 0.01f) {
        const Water basin = {.size = {6, 6}, .depth = 2};
        const WaterRipples ripples = {.cell = 0.05f};
        RippleState state = make_ripples(basin, ripples, kStep);
        water = world.create(
            basin, ripples, std::move(state),
            ParticleCollider{
                .shape = ColliderShape::Water, .ripple = ripple, .ripple_radius = 0.2f},
            WorldTransform{affine_from({0, 1, 0}, Quat(1, 0, 0, 0), Vec3(1))});
        if (amplitude > 0) {
            WaveTable waves;
            fill_wave_table(
                basin, WaterWaves{.waves = {{.amplitude = amplitude, .length = 4, .sharpness = 1}}},
                0.7, waves);
            world.add(water, waves);
        }
    }
    std::vector<RippleImpulse>& impulses() { return world.get<RippleState>(water).impulses; }
    WaterSurface surface() {
        WaterSurface surface;
        world.run([&](WaterQuery waters) { surface = collect_water_surfaces(waters).at(0); });
        return surface;
    }
};

}  // namespace

TEST_CASE(
    "particle obstacles: each drop that falls into water dies there and dents it once"
    * technique("particle.collision-loop")) {
    Pond scene;
    scene.drop({.action = CollisionAction::Kill});
    scene.run(60);
    CHECK(scene.pool().size() == 0);
    REQUIRE(scene.impulses().size() == 100);
    for (const RippleImpulse& dent : scene.impulses()) {
        CHECK(dent.height == near(-0.01));  // at 10 m/s
        CHECK(dent.radius == 0.2f);
        CHECK(glm::length(dent.center) < 0.41f);
    }
}

TEST_CASE("particle obstacles: drops end on the waves, where a query has them") {
    Pond scene(0.4f, 0);
    const Entity drops = scene.drop({.action = CollisionAction::Stick}, 100);
    ParticleEmitter& fast = scene.world.get<ParticleEmitter>(drops);
    fast.speed = -60;  // a meter each step
    fast.cone = 0.3f;
    scene.run(60);
    const WaterSurface surface = scene.surface();
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 100);
    const auto [low, high] = std::minmax_element(pool.y.begin(), pool.y.end());
    CHECK(*high - *low > 0.1f);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const WaterPoint there = sample_water(surface, {pool.x[i], pool.z[i]});
        CHECK(pool.y[i] == near(there.position.y).epsilon(2e-3));
    }
    CHECK(scene.impulses().empty());  // of a collider that ripples by 0
}

TEST_CASE("particle obstacles: a path enters water where it is as high as the surface") {
    Pond scene(0.4f, 0);
    const ParticleWater water = {.surface = scene.surface(), .highest = 1.5f};
    for (int i = 0; i < 100; ++i) {
        const float x = 0.05f * static_cast<float>(i - 50);
        const Vec3 from = {x, 2.5f, 0.3f};
        const Vec3 to = {-x, 0.2f, 0.5f * x};
        const auto contact = enter_water({&water, 1}, from, to);
        REQUIRE(contact);
        const Vec3 there = from + contact->fraction * (to - from);
        CHECK(glm::distance(contact->point, there) < 1e-3f);
        CHECK(!enter_water({&water, 1}, to, from));  // from below
        CHECK(!enter_water({&water, 1}, from, from + 0.5f * contact->fraction * (to - from)));
    }
}

TEST_CASE("particle obstacles: a roof keeps drops from the water, and what is below stays there") {
    Pond scene;
    const Entity drops = scene.drop({.action = CollisionAction::Kill});
    scene.world.get<ParticleEmitter>(drops).speed = -11;  // both are in the way of one step
    scene.add_square({0, 1.05f, 0}, 1);
    scene.run(60);
    CHECK(scene.pool().size() == 0);
    CHECK(scene.impulses().empty());
    const Entity bubbles = scene.drop({.action = CollisionAction::Kill});
    for (auto* position :
         {&scene.world.get<WorldTransform>(bubbles).world,
          &scene.world.get<PreviousWorldTransform>(bubbles).world}) {
        *position = affine_from({0, 0.9f, 0}, Quat(1, 0, 0, 0), Vec3(1));
    }
    scene.run(5);
    CHECK(scene.pool(1).size() == 100);
}

TEST_CASE("particle obstacles: off water they bounce as off a wall, by the surface response") {
    Pond scene;
    scene.drop({.bounce = 0.5f, .friction = 1, .radius = 0});
    scene.run(36);  // 0.4 s to the surface, then up at half the speed
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 100);
    for (std::size_t i = 0; i < pool.size(); ++i) {
        CHECK(pool.vy[i] == near(5));
        CHECK(pool.y[i] == near(1 + 5 * (36.0 / 60 - 0.4)).epsilon(2e-3));
    }
}

TEST_CASE("particle obstacles: no wave is above the bound on them") {
    Pond scene(0.4f);
    const WaterSurface surface = scene.surface();
    const float bound = highest_wave(surface);
    float highest = -1;
    for (float x = -3; x < 3; x += 0.02f) {
        highest = std::max(highest, sample_water(surface, {x, 0}).position.y - 1);
    }
    CHECK(highest <= bound);
    CHECK(bound < 0.401f);
}

}  // namespace limn::particle_obstacles_test
