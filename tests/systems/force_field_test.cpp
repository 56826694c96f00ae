// Fields of force: what each does to a particle, and that they add up.

#include "ecs/components/force_field.h"
#include "systems/particles/force_fields.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::test::force_field_test {
namespace {

Vec3 place_of(const ParticlePool& pool, std::size_t i = 0) {
    return {pool.x[i], pool.y[i], pool.z[i]};
}
Vec3 velocity_of(const ParticlePool& pool, std::size_t i = 0) {
    return {pool.vx[i], pool.vy[i], pool.vz[i]};
}

/// One particle at rest in the origin, that nothing but fields moves.
struct Field : Emitters {
    explicit Field(float step = kStep) : Emitters(step) {
        ParticleEmitter emitter = burst(1);
        emitter.speed = 0;
        add(emitter, falling(0));
    }
    Entity
    place(const ForceField& field, const Vec3& at = Vec3(0), const Quat& turn = {1, 0, 0, 0}) {
        return world.create(field, WorldTransform{affine_from(at, turn, Vec3(1))});
    }
};

}  // namespace

TEST_CASE("force fields: each kind accelerates as it says" * technique("particle.forces")) {
    Force force;
    force.strength = 3;
    force.origin = {1, 2, 3};
    force.axis = {0, 0, 1};
    const Vec3 at = {1, 6, 5};
    CHECK(acceleration(force, at, {}) == Vec3(0, 0, 3));
    force.kind = ForceKind::Attract;
    CHECK(glm::distance(acceleration(force, at, {}), Vec3(0, -12, -6) / std::sqrt(20.0f)) < 1e-6f);
    CHECK(acceleration(force, force.origin, {}) == Vec3(0));
    force.kind = ForceKind::Spring;
    CHECK(acceleration(force, at, {}) == Vec3(0, -12, -6));
    force.kind = ForceKind::Whirl;
    CHECK(acceleration(force, at, {}) == Vec3(-3, 0, 0));
    CHECK(acceleration(force, {1, 2, 9}, {}) == Vec3(0));  // on the axis
    force.kind = ForceKind::Wind;
    force.speed = 4;
    CHECK(acceleration(force, at, {1, 0, 4}) == Vec3(-3, 0, 0));
    // Half as strong at sqrt(1/2) of the radius, nothing beyond it.
    force.kind = ForceKind::Push;
    force.radius = std::sqrt(40.0f);
    CHECK(acceleration(force, at, {}).z == near(1.5f));
    force.radius = 4;
    CHECK(acceleration(force, at, {}) == Vec3(0));
}

TEST_CASE(
    "force fields: equal and opposite ones cancel; their order does not matter"
    * technique("particle.forces")) {
    Field still;
    still.place({.strength = 7});
    still.place({.strength = -7});
    still.place({.kind = ForceKind::Attract, .strength = 5}, {2, 0, 0});
    still.place({.kind = ForceKind::Attract, .strength = 5}, {-2, 0, 0});
    still.run(60);
    CHECK(glm::length(place_of(still.pool())) < 1e-6f);

    Random random(5, 4, 3, 2);
    std::vector<Force> forces(40);
    for (Force& force : forces) {
        force.kind = static_cast<ForceKind>(random.below(5));
        force.origin = 3.0f * random.direction();
        force.axis = random.direction();
        force.strength = random.uniform(-5, 5);
    }
    const auto pushed = [&] {
        ParticlePool pool;
        for (auto* const column :
             {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz, &pool.age, &pool.life}) {
            column->push_back(0.5f);
        }
        apply_forces(particle_block(pool, 0, 1), forces, 1, 1);
        return velocity_of(pool);
    };
    const Vec3 forward = pushed();
    std::reverse(forces.begin(), forces.end());
    CHECK(glm::distance(pushed(), forward) < 1e-5f * 40 * 5);
}

TEST_CASE(
    "force fields: one that swings as a sine gives a velocity of 1 - cos t"
    * technique("particle.forces")) {
    Field swing(0.001f);
    swing.place({.strength = 1, .frequency = 1 / (2 * kPi)});
    for (int i = 0; i < 6000; ++i) {
        swing.run();
        const double t = swing.world.resource<FrameTime>().time;
        CHECK(
            std::abs(static_cast<double>(velocity_of(swing.pool()).y) - (1 - std::cos(t))) < 1e-3);
    }
}

TEST_CASE(
    "force fields: particles in a wind take its speed, on a spring they swing"
    * technique("particle.forces")) {
    Field wind;
    wind.place({.kind = ForceKind::Wind, .strength = 4, .speed = 3});
    wind.run(60);
    CHECK(velocity_of(wind.pool()).y == near(3 * (1 - std::exp(-4.0))).epsilon(0.01));

    Field spring(0.001f);
    spring.place({.kind = ForceKind::Spring, .strength = 4 * kPi * kPi}, {0, 1, 0});
    spring.run(500);  // half of a swing of one second
    CHECK(place_of(spring.pool()).y == near(2).epsilon(0.01));
    spring.run(500);
    CHECK(std::abs(place_of(spring.pool()).y) < 0.02f);
}

TEST_CASE("force fields: an emitter scales them, or ignores them") {
    for (const float fraction : {0.0f, 1.0f, -2.5f}) {
        Emitters scene;
        ParticleEmitter emitter = burst(1);
        emitter.speed = 0;
        scene.add(emitter, {.gravity = 0, .fields = fraction});
        const Quat leaning = glm::normalize(Quat(0.8f, 0.1f, 0.3f, -0.2f));
        scene.world.create(
            ForceField{.strength = 2}, WorldTransform{affine_from({}, leaning, Vec3(1))});
        scene.run(60);
        const Vec3 expected = 2 * fraction * (leaning * Vec3(0, 1, 0));
        CHECK(
            glm::distance(velocity_of(scene.pool()), expected)
            < 0.04f * std::abs(fraction) + 1e-6f);
    }
}

TEST_CASE("force fields: numbers that are not finite count as none") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Field broken;
    broken.place({.strength = nan});
    broken.place({.strength = 3, .radius = nan}, Vec3(nan));
    broken.place({.kind = ForceKind::Wind, .strength = 1, .speed = nan});
    broken.place({.strength = 1, .frequency = 2, .phase = nan});
    broken.run(10);
    CHECK(std::isfinite(glm::length(place_of(broken.pool()))));
}

}  // namespace limn::test::force_field_test
