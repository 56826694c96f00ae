#include "ecs/components/all.h"
#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/particles/trail_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace limn::trail_test {
namespace {

using Path = std::function<Vec3(float)>;

Affine at(const Vec3& position) {
    return affine_from(position, {1, 0, 0, 0}, {1, 1, 1});
}

/// An entity with a trail that is moved along a path.
struct Flight {
    World world;
    Entity entity;
    float time = 0;

    Flight(const Trail& trail, const Vec3& start, float step) {
        register_all_components();
        world.insert_resource(FrameTime{.step = step});
        entity = world.create(trail, WorldTransform{at(start)}, PreviousWorldTransform{at(start)});
        world.run(add_trail_states);
    }
    void move_to(const Affine& pose) {
        Affine& now = world.get<WorldTransform>(entity).world;
        world.get<PreviousWorldTransform>(entity).world = now;
        now = pose;
        world.run(update_trails);
    }
    void fly(const Path& path, float until) {
        const float step = world.resource<FrameTime>().step;
        while (time < until - 0.5f * step) {
            time += step;
            move_to(at(path(time)));
        }
    }
    const TrailState& state() { return world.get<const TrailState>(entity); }
    /// Of the last strand, from the oldest.
    std::vector<TrailPoint> points() {
        std::vector<TrailPoint> list;
        const TrailStrand& strand = state().strands.back();
        for (std::uint32_t i = 0; i < strand.count; ++i) {
            list.push_back(trail_point(state(), strand, i));
        }
        return list;
    }
};

Vec3 circle(float time) {
    return {2 * std::cos(3 * time), 1, 2 * std::sin(3 * time)};
}

float distance_to(const std::vector<TrailPoint>& line, const Vec3& point) {
    float nearest = 1e9f;
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Vec3 a = line[i - 1].position;
        const Vec3 path = line[i].position - a;
        const float t = glm::clamp(glm::dot(point - a, path) / glm::dot(path, path), 0.0f, 1.0f);
        nearest = std::min(nearest, glm::distance(point, a + path * t));
    }
    return nearest;
}

}  // namespace

TEST_CASE(
    "trail: a straight flight leaves a point at every spacing, as old as its passing"
    * technique("engine.trail")) {
    const Trail trail = {.spacing = 0.25f, .length = 100, .life = 100};
    for (const float step : {1.0f / 30, 1.0f / 144, 0.5f}) {
        CAPTURE(step);
        Flight flight(trail, Vec3(0), step);
        flight.fly([](float time) { return Vec3(5 * time, 0, 0); }, 4);
        const std::vector<TrailPoint> points = flight.points();
        REQUIRE(points.size() >= 80);  // 20 m; the last may not be due yet
        CHECK(points.size() <= 81);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double along = 0.25 * static_cast<double>(i);
            CHECK(points[i].position.x == test::near(along).scale(1).epsilon(1e-4));
            CHECK(points[i].age == test::near(4 - along / 5).scale(1).epsilon(1e-4));
        }
    }
}

TEST_CASE(
    "trail: on a circle points are a spacing apart and extend no farther than the length"
    * technique("engine.trail")) {
    const Trail trail = {.spacing = 0.1f, .length = 5, .life = 100};
    Flight flight(trail, circle(0), 1.0f / 60);
    flight.fly(circle, 10);
    const std::vector<TrailPoint> points = flight.points();
    for (std::size_t i = 1; i < points.size(); ++i) {
        CHECK(
            glm::distance(points[i].position, points[i - 1].position)
            == test::near(0.1).epsilon(1e-3));
    }
    CHECK(points.size() >= 51);
    CHECK(points.size() <= 53);  // one beyond, and those of a step
    for (const TrailPoint& point : points) {
        CHECK(std::hypot(point.position.x, point.position.z) == test::near(2).epsilon(2e-3));
    }
}

TEST_CASE("trail: it is the same at 30, 60 and 144 steps a second") {
    const Trail trail = {.spacing = 0.1f, .length = 5, .life = 100};
    Flight fine(trail, circle(0), 1.0f / 480);
    fine.fly(circle, 2);
    for (const float rate : {30.0f, 60.0f, 144.0f}) {
        CAPTURE(rate);
        Flight flight(trail, circle(0), 1 / rate);
        flight.fly(circle, 2);
        const std::vector<TrailPoint> points = flight.points();
        REQUIRE(points.size() > 50);
        for (std::size_t i = points.size() - 50; i < points.size(); ++i) {
            CHECK(distance_to(fine.points(), points[i].position) < 0.05f * trail.spacing);
        }
        // Straight steps would leave the circle by 5 mm at 30 a second.
        for (const TrailPoint& point : flight.points()) {
            CHECK(std::abs(std::hypot(point.position.x, point.position.z) - 2) < 2.5e-3f);
        }
    }
}

TEST_CASE(
    "trail: what stands still leaves none, and what stops loses its own in a life"
    * technique("engine.trail")) {
    const Trail trail = {.spacing = 0.1f, .length = 5, .life = 0.5f};
    Flight flight(trail, Vec3(0), 1.0f / 60);
    flight.fly([](float) { return Vec3(0); }, 1);
    CHECK(flight.points().size() == 1);
    flight.fly([](float time) { return Vec3(4 * (time - 1), 0, 0); }, 2);
    CHECK(flight.points().size() > 15);
    flight.fly([](float) { return Vec3(4, 0, 0); }, 2.8f);
    CHECK(flight.points().size() == 1);
    flight.world.get<Trail>(flight.entity).active = false;
    flight.fly([](float) { return Vec3(4, 0, 0); }, 3.5f);
    CHECK(flight.state().strands.empty());
}

TEST_CASE("trail: a jump, a teleport and NaN break it" * technique("engine.trail")) {
    const Trail trail = {.spacing = 0.1f, .length = 50, .life = 100, .jump = 2};
    Flight flight(trail, Vec3(0), 1.0f / 60);
    flight.fly([](float time) { return Vec3(5 * time, 0, 0); }, 1);
    flight.move_to(at({100, 0, 0}));  // farther than a jump
    CHECK(flight.state().strands.size() == 2 + 1);
    flight.world.get<WorldTransform>(flight.entity).world = at({100.5f, 0, 0});  // a teleport
    flight.move_to(at({100.6f, 0, 0}));
    CHECK(flight.state().strands.size() == 4);
    flight.move_to(at(Vec3(std::numeric_limits<float>::quiet_NaN())));
    flight.move_to(at({101, 0, 0}));
    flight.move_to(at({102, 0, 0}));
    CHECK(flight.state().strands.size() == 5);
    int live = 0;
    for (const TrailStrand& strand : flight.state().strands) {
        live += strand.live ? 1 : 0;
        for (std::uint32_t i = 0; i < strand.count; ++i) {
            const Vec3 position = trail_point(flight.state(), strand, i).position;
            CHECK(std::isfinite(position.x));
            CHECK(glm::distance(position, strand.head.position) < 10);
        }
    }
    CHECK(live == 1);
}

TEST_CASE("trail: the span turns with the entity") {
    const Trail trail = {.spacing = 0.1f, .length = 5, .life = 9, .span = {2, 0, 0}};
    Flight flight(trail, Vec3(0), 1.0f / 60);
    const Quat turned = glm::angleAxis(kPi / 2, Vec3(0, 0, 1));
    flight.move_to(affine_from({0.1f, 0, 0}, turned, {1, 1, 1}));
    flight.move_to(affine_from({0.3f, 0, 0}, turned, {1, 1, 1}));
    CHECK(glm::distance(flight.points().back().span, Vec3(0, 2, 0)) < 1e-5f);
    CHECK(glm::distance(flight.points().front().span, Vec3(2, 0, 0)) < 1e-5f);
}

TEST_CASE(
    "trail: each particle has its own, which outlives it by a life and takes no new memory"
    * technique("engine.trail")) {
    World world;
    register_all_components();
    const float step = 1.0f / 60;
    world.insert_resource(FrameTime{.step = step});
    const Entity emitter = world.create(ParticlePool{});
    const Trail trail = {
        .path = TrailPath::Particles,
        .emitter = emitter,
        .spacing = 0.05f,
        .length = 1,
        .life = 0.3f,
        .count = 8};
    const Entity entity = world.create(trail);
    world.run(add_trail_states);
    std::size_t bytes = 0;
    for (std::uint32_t frame = 0; frame < 600; ++frame) {
        auto& pool = world.get<ParticlePool>(emitter);
        // One is born every ten steps and lives for a half to one second: not in order.
        if (frame % 10 == 0) {
            for (auto* const column : {&pool.x, &pool.y, &pool.z, &pool.vx, &pool.vy, &pool.vz}) {
                column->push_back(0);
            }
            pool.vx.back() = 3;
            pool.z.back() = static_cast<float>(pool.clock.born);
            pool.age.push_back(-0.5f * step);
            pool.life.push_back(0.5f + 0.25f * static_cast<float>(pool.clock.born % 3));
            pool.look.push_back(static_cast<std::uint32_t>(pool.clock.born * 0x9e3779b9u));
            ++pool.clock.born;
        }
        ParticlePool left;
        for (std::size_t i = 0; i < pool.size(); ++i) {
            if (pool.age[i] + step < pool.life[i]) {
                left.x.push_back(pool.x[i] + pool.vx[i] * (pool.age[i] < 0 ? 0.5f * step : step));
                left.y.push_back(0);
                left.z.push_back(pool.z[i]);
                left.vx.push_back(3);
                left.vy.push_back(0);
                left.vz.push_back(0);
                left.age.push_back(pool.age[i] + step);
                left.life.push_back(pool.life[i]);
                left.look.push_back(pool.look[i]);
            }
        }
        left.clock.born = pool.clock.born;
        pool = left;
        world.run(update_trails);
        const auto& state = world.get<const TrailState>(entity);
        std::size_t live = 0;
        for (const TrailStrand& strand : state.strands) {
            live += strand.live ? 1 : 0;
            const float z = strand.head.position.z;
            for (std::uint32_t i = 0; i < strand.count; ++i) {
                CHECK(trail_point(state, strand, i).position.z == z);
            }
        }
        CHECK(live == std::min<std::size_t>(pool.size(), 8));
        if (frame == 200) {
            bytes = state.points.size();
        }
        CHECK((frame < 200 || state.points.size() == bytes));
    }
    world.get<ParticlePool>(emitter) = {};
    for (int i = 0; i < 15; ++i) {
        world.run(update_trails);
    }
    CHECK_FALSE(world.get<const TrailState>(entity).strands.empty());
    for (int i = 0; i < 6; ++i) {
        world.run(update_trails);
    }
    CHECK(world.get<const TrailState>(entity).strands.empty());
}

}  // namespace limn::trail_test
