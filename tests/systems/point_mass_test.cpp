// Flight of points with a mass: cannonballs and rockets.

#include "ecs/components/all.h"
#include "ecs/components/lifetime.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/point_mass_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace limn::test::point_mass_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kGravity = 9.81;
/// 1/2 density coefficient area of the default sphere [kg/m].
constexpr float kSphereDrag = 0.5f * 1.225f * 0.47f * kPi * 0.1f * 0.1f;

PointMass thrown(float speed, double angle_deg) {
    const auto angle = static_cast<float>(angle_deg * 3.14159265358979 / 180);
    return {.velocity = speed * Vec3(std::cos(angle), std::sin(angle), 0)};
}

PointMassForces falling_in_air(float drag) {
    return {.acceleration = {0, static_cast<float>(-kGravity), 0}, .drag = drag};
}

struct Arc {
    double range = 0;
    double apex = 0;
    double time = 0;
    Vec3 last_velocity = {0, 0, 0};
};

/// Until it is down again; the last piece is straight.
Arc fly(PointMass body, float drag, float dt) {
    Arc arc;
    double x = 0;
    double y = 0;
    while (true) {
        const PointMass next = step_point_mass(body, falling_in_air(drag), dt);
        const double step = static_cast<double>(dt);
        const double dx = 0.5 * static_cast<double>(body.velocity.x + next.velocity.x) * step;
        const double dy = 0.5 * static_cast<double>(body.velocity.y + next.velocity.y) * step;
        if (y + dy < 0) {
            const double fraction = y / -dy;
            arc.range = x + fraction * dx;
            arc.time += fraction * step;
            arc.last_velocity = next.velocity;
            return arc;
        }
        x += dx;
        y += dy;
        arc.time += step;
        arc.apex = std::max(arc.apex, y);
        body = next;
    }
}

/// Runge and Kutta's fourth order, in double precision.
glm::dvec4 reference_after(double speed, double drag_per_mass, double time) {
    const auto slope = [&](const glm::dvec4& s) {
        const double v = std::hypot(s.z, s.w);
        return glm::dvec4(s.z, s.w, -drag_per_mass * v * s.z, -drag_per_mass * v * s.w - kGravity);
    };
    constexpr int kSteps = 20000;
    const double h = time / kSteps;
    glm::dvec4 s(0, 0, speed * std::sqrt(0.5), speed * std::sqrt(0.5));
    for (int i = 0; i < kSteps; ++i) {
        const glm::dvec4 a = slope(s);
        const glm::dvec4 b = slope(s + 0.5 * h * a);
        const glm::dvec4 c = slope(s + 0.5 * h * b);
        const glm::dvec4 d = slope(s + h * c);
        s += h / 6 * (a + 2.0 * b + 2.0 * c + d);
    }
    return s;
}

/// A world whose bodies fly, and an obstacle if there is one.
struct Bodies {
    World world;

    explicit Bodies(float step = kStep) {
        register_all_components();
        world.insert_resource(FrameTime{.step = step});
        world.insert_resource(WeatherState{});
        world.insert_resource(Assets{});
        world.insert_resource(ParticleObstacles{});
    }
    void add_floor() {
        world.create(ParticleCollider{}, WorldTransform{affine_from({}, {1, 0, 0, 0}, Vec3(1))});
    }
    void run(int steps = 1) {
        for (int i = 0; i < steps; ++i) {
            FrameTime& time = world.resource<FrameTime>();
            time.time += static_cast<double>(time.step);
            ++time.frame;
            world.run(find_particle_obstacles);
            world.run(update_point_masses);
        }
    }
    Vec3 position(Entity body) { return world.get<const Transform>(body).position; }
    const PointMass& mass(Entity body) { return world.get<const PointMass>(body); }
};

}  // namespace

TEST_CASE(
    "projectile: without air it flies the parabola of 254.842 m in 7.20802 s"
    * technique("particle.projectile")) {
    const Arc arc = fly(thrown(50, 45), 0, 0.001f);
    CHECK(arc.range == near(254.841998).epsilon(1e-3));
    CHECK(arc.apex == near(63.710499).epsilon(1e-3));
    CHECK(arc.time == near(7.208020).epsilon(1e-3));
}

TEST_CASE(
    "projectile: without air it flies farthest at 45 degrees" * technique("particle.projectile")) {
    const double best = fly(thrown(50, 45), 0, 0.01f).range;
    for (int angle = 5; angle < 90; angle += 5) {
        CAPTURE(angle);
        CHECK((angle == 45 || fly(thrown(50, angle), 0, 0.01f).range < best));
    }
}

TEST_CASE(
    "projectile: with air the range is smaller and the descent steeper than the ascent"
    * technique("particle.projectile")) {
    for (const double angle : {20.0, 45.0, 70.0}) {
        CAPTURE(angle);
        const Arc free = fly(thrown(50, angle), 0, kStep);
        const Arc slowed = fly(thrown(50, angle), kSphereDrag, kStep);
        CHECK(slowed.range < 0.9 * free.range);
        const Vec3 last = slowed.last_velocity;
        CHECK(std::atan2(-last.y, last.x) > angle * 3.14159 / 180 + 0.05);
        const Vec3 last_free = free.last_velocity;
        CHECK(
            std::atan2(-last_free.y, last_free.x) == near(angle * 3.14159265 / 180).epsilon(0.01));
    }
}

TEST_CASE(
    "projectile: with air it is where Runge and Kutta have it, to the step's square"
    * technique("particle.projectile")) {
    double last_error = 0;
    for (const int steps : {30, 60, 120}) {  // of 4 s
        const float dt = 4.0f / static_cast<float>(steps);
        PointMass body = thrown(90, 45);
        Vec3 position(0);
        for (int i = 0; i < steps; ++i) {
            const PointMass next = step_point_mass(body, falling_in_air(kSphereDrag), dt);
            position += 0.5f * dt * (body.velocity + next.velocity);
            body = next;
        }
        const glm::dvec4 exact = reference_after(90, static_cast<double>(kSphereDrag) / 5, 4);
        const double error = glm::distance(glm::dvec2(position.x, position.y), glm::dvec2(exact));
        CHECK(error < 1.2 * static_cast<double>(dt * dt));  // of 170 m
        CHECK((last_error == 0 || error < 0.3 * last_error));
        last_error = error;
    }
}

TEST_CASE(
    "projectile: it ends at the terminal speed of 73.6449 m/s, whatever the step"
    * technique("particle.projectile")) {
    for (const float dt : {0.001f, kStep, 0.1f}) {
        CAPTURE(dt);
        PointMass body{.velocity = {3, 200, 0}};
        for (float time = 0; time < 120; time += dt) {
            body = step_point_mass(body, falling_in_air(kSphereDrag), dt);
        }
        CHECK(body.velocity.y == near(-73.6449).epsilon(1e-4));
        CHECK(std::abs(body.velocity.x) < 1e-4f);
    }
}

TEST_CASE(
    "projectile: drag is opposite to the flight, and never turns it around"
    * technique("particle.projectile")) {
    for (const float drag : {0.01f, 1.0f, 1e6f}) {
        for (const Vec3& velocity : {Vec3(3, -4, 12), Vec3(500, 0, 1), Vec3(0, 0.1f, 0)}) {
            const PointMass next = step_point_mass({.velocity = velocity}, {.drag = drag}, 0.1f);
            const Vec3 change = next.velocity - velocity;
            CHECK(
                glm::length(glm::cross(change, velocity))
                <= 1e-5f * glm::length(velocity) * glm::length(velocity));
            CHECK(glm::dot(next.velocity, velocity) >= 0);
            CHECK(glm::length(next.velocity) < glm::length(velocity));
        }
    }
    // Relative to the air: who goes along with the wind feels none.
    const PointMassForces wind = {.air = {7, 0, 0}, .drag = 1};
    CHECK(step_point_mass({.velocity = {7, 0, 0}}, wind, 0.1f).velocity == Vec3(7, 0, 0));
    CHECK(step_point_mass({.velocity = {0, 0, 0}}, wind, 0.1f).velocity.x > 0.5f);
}

TEST_CASE(
    "variable mass: in space a rocket gains u ln(m0 / m1), whatever the step"
    * technique("particle.variable-mass")) {
    for (const int steps : {1, 7, 1000}) {
        CAPTURE(steps);
        PointMass rocket{.mass = 2000};
        const PointMassForces thrust = {
            .burned = 1000.0f / static_cast<float>(steps), .exhaust = {0, -1000, 0}};
        for (int i = 0; i < steps; ++i) {
            rocket = step_point_mass(rocket, thrust, 0.1f);
        }
        CHECK(rocket.mass == near(1000).epsilon(1e-5));
        CHECK(rocket.velocity.y == near(693.147).epsilon(2e-5));
        CHECK(rocket.velocity.x == 0.0f);
    }
}

TEST_CASE(
    "variable mass: as momentum m v stays, so that half the mass is twice as fast"
    * technique("particle.variable-mass")) {
    PointMass body{.velocity = {3, 0, -2}, .mass = 8};
    for (int i = 0; i < 40; ++i) {
        body = step_point_mass(
            body, {.burned = 0.1f, .exhaust = {900, 0, 0}, .keeps_momentum = true}, kStep);
    }
    CHECK(body.mass == near(4));
    CHECK(body.velocity.x == near(6).epsilon(1e-4));
    CHECK(body.velocity.z == near(-4).epsilon(1e-4));
}

TEST_CASE(
    "variable mass: without a burn it is the plain law, bit for bit"
    * technique("particle.variable-mass")) {
    for (const bool keeps : {false, true}) {
        const PointMass plain = step_point_mass(thrown(50, 30), falling_in_air(kSphereDrag), kStep);
        PointMassForces forces = falling_in_air(kSphereDrag);
        forces.exhaust = {0, 1000, 0};
        forces.keeps_momentum = keeps;
        const PointMass other = step_point_mass(thrown(50, 30), forces, kStep);
        CHECK(other.velocity == plain.velocity);
        CHECK(other.mass == plain.mass);
    }
}

TEST_CASE(
    "variable mass: it burns out at the dry mass and then falls as a stone does"
    * technique("particle.variable-mass")) {
    Bodies scene;
    const Entity rocket = scene.world.create(
        Transform{}, PointMass{.mass = 3},
        VariableMass{.burn_rate = 2, .dry_mass = 2, .exhaust = {0, -400, 0}});
    for (int i = 0; i < 29; ++i) {
        scene.run();
        CHECK(scene.mass(rocket).mass > 2);
    }
    scene.run(3);
    CHECK(scene.mass(rocket).mass == 2.0f);
    CHECK(
        scene.mass(rocket).velocity.y
        == near(400 * std::log(1.5) - kGravity * 32 / 60).epsilon(1e-4));
    const float before = scene.mass(rocket).velocity.y;
    scene.run(30);
    CHECK(scene.mass(rocket).mass == 2.0f);
    CHECK(scene.mass(rocket).velocity.y - before == near(-kGravity / 2).epsilon(1e-4));
}

TEST_CASE(
    "variable mass: exhaust turns with the body, whose -z aims along the flight"
    * technique("particle.variable-mass")) {
    Bodies scene;
    const Quat up = glm::angleAxis(0.5f * kPi, Vec3(1, 0, 0));  // -z becomes +y
    const Entity rocket = scene.world.create(
        Transform{.rotation = up}, PointMass{.mass = 2, .gravity = 0, .aim = true},
        VariableMass{.burn_rate = 0.5f, .dry_mass = 1, .exhaust = {0, 0, 300}});
    scene.run(60);
    CHECK(scene.mass(rocket).velocity.y == near(300 * std::log(2 / 1.5)).epsilon(1e-3));
    scene.world.get<PointMass>(rocket).velocity = {0, 0, 40};
    scene.run();
    const Quat turn = scene.world.get<const Transform>(rocket).rotation;
    const Vec3 ahead = turn * Vec3(0, 0, -1);
    CHECK(glm::dot(ahead, glm::normalize(scene.mass(rocket).velocity)) == near(1));
    CHECK(glm::length(turn) == near(1));
}

TEST_CASE(
    "point mass: its entity is where the mean velocity brings it; fields and wind move it"
    * technique("particle.projectile")) {
    Bodies scene;
    const Entity ball =
        scene.world.create(Transform{.position = {1, 2, 3}}, PointMass{.velocity = {5, 0, 0}});
    scene.world.insert_resource(Weather{.wind_speed = 10});
    const Entity leaf = scene.world.create(
        Transform{}, PointMass{.mass = 0.001f, .gravity = 0}, AirDrag{.weather = 1});
    scene.run(60);
    CHECK(scene.position(ball).x == near(6).epsilon(1e-4));
    CHECK(scene.position(ball).y == near(2 - kGravity / 2).epsilon(1e-4));
    CHECK(scene.position(ball).z == 3.0f);
    CHECK(scene.mass(leaf).velocity.x == near(10).epsilon(0.05));
    scene.world.create(ForceField{.strength = 9.81f}, WorldTransform{Affine{}});  // up
    const float before = scene.mass(ball).velocity.y;
    scene.run(60);
    CHECK(scene.mass(ball).velocity.y == near(before).epsilon(1e-4));
}

TEST_CASE(
    "point mass: it keeps a fraction of its speed when it bounces, ends by a hit, or sticks"
    * technique("particle.projectile")) {
    for (const CollisionAction action :
         {CollisionAction::Bounce, CollisionAction::Kill, CollisionAction::Stick}) {
        CAPTURE(static_cast<int>(action));
        Bodies scene;
        scene.add_floor();
        const Entity ball = scene.world.create(
            Transform{.position = {0, 10, 0}}, PointMass{.velocity = {0, -60, 0}, .gravity = 0},
            ParticleCollision{.action = action, .bounce = 0.5f, .radius = 0.2f});
        scene.run(9);
        CHECK_FALSE(scene.world.has<Lifetime>(ball));
        scene.run(2);
        CHECK(scene.world.has<Lifetime>(ball) == (action == CollisionAction::Kill));
        const Vec3 position = scene.position(ball);
        CHECK(position.y > 0.2f);
        if (action == CollisionAction::Bounce) {
            CHECK(scene.mass(ball).velocity.y == near(30));
        }
        scene.run(30);
        if (action == CollisionAction::Stick) {
            CHECK(scene.position(ball).y == near(0.2).epsilon(1e-2));
            CHECK(scene.mass(ball).velocity == Vec3(0));
        }
    }
}

TEST_CASE(
    "point mass: without mass, or with NaN, it stays and stops"
    * technique("particle.projectile")) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    Bodies scene;
    scene.add_floor();
    const Entity fixed = scene.world.create(
        Transform{.position = {1, 2, 3}}, PointMass{.velocity = {1, 1, 1}, .mass = 0});
    scene.run(10);
    CHECK(scene.position(fixed) == Vec3(1, 2, 3));
    for (const float bad : {kNan, kInf, -kInf, 1e30f, -1e30f, 0.0f}) {
        CAPTURE(bad);
        for (int field = 0; field < 12; ++field) {
            CAPTURE(field);
            PointMass body{.velocity = {1, 2, 3}};
            AirDrag drag;
            VariableMass fuel;
            ParticleCollision collision;
            float* const fields[] = {&body.velocity.x, &body.mass,        &body.gravity,
                                     &body.fields,     &drag.radius,      &drag.density,
                                     &drag.weather,    &fuel.burn_rate,   &fuel.dry_mass,
                                     &fuel.exhaust.z,  &collision.radius, &collision.bounce};
            *fields[field] = bad;
            const Entity entity =
                scene.world.create(Transform{.position = {0, 5, 0}}, body, drag, fuel, collision);
            scene.run(30);
            CHECK(is_finite(scene.position(entity)));
            CHECK(is_finite(scene.mass(entity).velocity));
            scene.world.destroy(entity);
        }
    }
}

}  // namespace limn::test::point_mass_test
