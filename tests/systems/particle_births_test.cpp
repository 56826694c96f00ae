#include "ecs/components/camera.h"
#include "ecs/components/particles.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_spray.h"
#include "systems/particles/birth_attributes.h"
#include "systems/particles/birth_kernels.h"
#include "systems/particles/emitter_pose.h"
#include "systems/particles/particle_births.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace limn::particle_births_test {

using namespace limn::test;

TEST_CASE(
    "particles: ten a step are ten, 2.5 a step are 250 in a hundred, none for a negative rate"
    * technique("particle.emission-rate")) {
    Emitters scene;
    scene.add(steady(10 / kStep));
    scene.add(steady(2.5f / kStep));
    scene.add(steady(-50));
    for (int i = 1; i <= 100; ++i) {
        scene.run();
        CHECK(scene.pool(0).size() == static_cast<std::size_t>(10 * i));
    }
    CHECK(scene.pool(1).size() == 250);
    CHECK(scene.pool(2).size() == 0);
}

TEST_CASE(
    "particles: births that vary by half have the mean rate, whatever the step"
    * technique("particle.emission-rate")) {
    for (const float step : {1.0f / 200, 1.0f / 30}) {
        CAPTURE(step);
        Emitters scene(step);
        ParticleEmitter emitter = steady(300);
        emitter.rate_spread = 150;
        emitter.life = 0.01f;
        scene.add(emitter);
        const int steps = static_cast<int>(100 / step);
        scene.run(steps);
        CHECK(std::abs(static_cast<double>(scene.pool().clock.born) / 30000 - 1) < 0.01);
    }
}

TEST_CASE(
    "particles: a rate along a curve gives its integral" * technique("particle.emission-rate")) {
    Emitters scene;
    ParticleEmitter emitter = steady(600);
    emitter.duration = 4;
    emitter.loop = false;
    emitter.rate_curve = {{0, 0}, {1, 1}};
    scene.add(emitter);
    scene.run(120);
    CHECK(std::abs(static_cast<double>(scene.pool().clock.born) - 300) <= 1);  // 600 t^2 / 8
    scene.run(300);
    CHECK(std::abs(static_cast<double>(scene.pool().clock.born) - 1200) <= 1);

    Emitters falling_rate;
    emitter.rate_curve = {{0, 1}, {1, 0}};
    emitter.life = 0.5f;
    falling_rate.add(emitter);
    std::size_t last = 0;
    for (int i = 0; i < 4; ++i) {
        falling_rate.run(55);
        CHECK((i == 0 || falling_rate.pool().size() < last));
        last = falling_rate.pool().size();
    }
}

TEST_CASE(
    "particles: by screen area, half the area are half the births"
    * technique("particle.emission-rate")) {
    Emitters scene;
    const Entity eye =
        scene.world.create(Camera{.fov_y = 1}, WorldTransform{}, PreviousWorldTransform{Affine{}});
    const auto seen_from = [&](float distance) {
        scene.world.get<WorldTransform>(eye).world =
            affine_from({0, 0, distance}, Quat(1, 0, 0, 0), Vec3(1));
    };
    ParticleEmitter emitter = steady(1e5f);
    emitter.by_screen_area = true;
    emitter.size = {0.5f, 0.2f, 0.1f};
    seen_from(10);
    scene.add(emitter);
    scene.run(60);
    const auto near = static_cast<double>(scene.pool().clock.born);
    seen_from(10 * std::sqrt(2.0f));
    scene.run(60);
    const auto far = static_cast<double>(scene.pool().clock.born) - near;
    CHECK(far / near == test::near(0.5).epsilon(0.01));
    // A ball of 0.5 m at 10 m, in an image of 2 tan(0.5) by 16 / 9 of it.
    const double height = 2 * std::tan(0.5);
    const double fraction = 3.14159 * 0.25 / 99.75 / (height * height * 16 / 9);
    CHECK(near == test::near(1e5 * fraction).epsilon(0.01));
    seen_from(0.1f);
    scene.run(1);
    CHECK(
        static_cast<double>(scene.pool().clock.born) - near - far
        == test::near(1e5 / 60).epsilon(0.01));
}

TEST_CASE("particles: births are evenly spaced in time, across steps too") {
    Emitters scene;
    scene.add(steady(7 / kStep), falling(0));
    scene.run(5);
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 35);
    for (std::size_t i = 1; i < pool.size(); ++i) {
        CHECK(pool.age[i - 1] - pool.age[i] == test::near(kStep / 7).epsilon(1e-3));
        CHECK(pool.y[i - 1] - pool.y[i] == test::near(kStep / 7).epsilon(1e-3));  // 1 m/s
    }
    CHECK(pool.age.back() >= 0);
    CHECK(pool.age.front() <= 5 * kStep);
}

TEST_CASE("particles: bursts come at their times, repeat, and start over with the duration") {
    Emitters scene(0.1f);
    ParticleEmitter emitter = steady(0);
    emitter.bursts = {{.time = 0.25f, .count = 5, .spread = 0, .interval = 0.5f, .repeats = 2}};
    scene.add(emitter);
    emitter.duration = 0.65f;
    scene.add(emitter);
    emitter.loop = false;
    scene.add(emitter);
    std::vector<int> once;
    std::vector<int> looped;
    std::vector<int> ended;
    for (int i = 0; i < 20; ++i) {
        scene.run();
        once.push_back(static_cast<int>(scene.pool(0).clock.born));
        looped.push_back(static_cast<int>(scene.pool(1).clock.born));
        ended.push_back(static_cast<int>(scene.pool(2).clock.born));
    }
    // At 0.25, 0.75 and 1.25 s.
    CHECK(once[1] == 0);
    CHECK(once[2] == 5);
    CHECK(once[7] == 10);
    CHECK(once[12] == 15);
    CHECK(once.back() == 15);
    // Only the first is within 0.65 s: at 0.25, 0.9 and 1.55 s.
    CHECK(looped[2] == 5);
    CHECK(looped[7] == 5);
    CHECK(looped[9] == 10);
    CHECK(looped[15] == 15);
    CHECK(looped.back() == 15);
    CHECK(ended.back() == 5);
}

TEST_CASE(
    "particles: attributes are within their spread, and reach its ends"
    * technique("particle.system")) {
    Emitters scene;
    ParticleEmitter emitter = burst(5000);
    emitter.speed = 3;
    emitter.speed_spread = 1;
    emitter.life = 2;
    emitter.life_spread = 0.5f;
    scene.add(emitter, falling(0));
    scene.run();
    const ParticlePool& pool = scene.pool();
    const auto [slow, fast] = std::minmax_element(pool.vy.begin(), pool.vy.end());
    CHECK(*slow >= 2.0f);
    CHECK(*slow < 2.01f);
    CHECK(*fast <= 4.0f);
    CHECK(*fast > 3.99f);
    const auto [early, late] = std::minmax_element(pool.life.begin(), pool.life.end());
    CHECK(*early >= 1.5f);
    CHECK(*late <= 2.5f);
    CHECK(*late - *early > 0.99f);
}

TEST_CASE("particles: shapes are filled evenly" * technique("particle.generation-shape")) {
    Random random(1, 2, 3, 4);
    constexpr int kCount = 100000;
    struct Case {
        EmitterShape shape;
        double half_share;  // of the points, within half the radius
        int axes;           // that have an extent
    };
    for (const Case& one :
         {Case{EmitterShape::Ball, 0.125, 3}, Case{EmitterShape::Disc, 0.25, 2},
          Case{EmitterShape::Sphere, 0, 3}, Case{EmitterShape::Circle, 0, 2}}) {
        CAPTURE(static_cast<int>(one.shape));
        const Vec3 size = {2, 3, 4};
        int near = 0;
        glm::dvec3 sum(0);
        for (int i = 0; i < kCount; ++i) {
            const Vec3 p = sample_shape(one.shape, size, random) / size;
            const float radius = glm::length(p);
            REQUIRE(radius <= 1.00001f);
            REQUIRE((one.half_share > 0 || radius >= 0.99999f));
            REQUIRE((one.axes == 3 || p.y == 0.0f));
            near += radius < 0.5f ? 1 : 0;
            sum += glm::dvec3(p);
        }
        CHECK(near / double{kCount} == test::near(one.half_share).scale(1).epsilon(0.005));
        CHECK(glm::length(sum) / kCount < 0.01);
    }
    Vec3 high(0);
    for (int i = 0; i < kCount; ++i) {
        const Vec3 p = sample_shape(EmitterShape::Box, {1, 2, 3}, random);
        high = glm::max(high, glm::abs(p));
        REQUIRE(glm::all(glm::lessThanEqual(glm::abs(p), Vec3(1, 2, 3))));
    }
    CHECK(glm::length(high - Vec3(1, 2, 3)) < 0.01f);
    CHECK(sample_shape(EmitterShape::Point, {1, 2, 3}, random) == Vec3(0));
}

TEST_CASE(
    "particles: the torus of the book is a ring without a hole in its tube"
    * technique("particle.million")) {
    Random random(1, 2, 3, 4);
    Vec3 sum(0);
    int inner = 0;
    constexpr int kCount = 50000;
    for (int i = 0; i < kCount; ++i) {
        const Vec3 p = sample_shape(EmitterShape::Torus, {10, 1, 10}, random);
        const float across = std::sqrt(p.x * p.x + p.z * p.z) - 10;
        REQUIRE(across * across + p.y * p.y <= 1.00001f);
        inner += across * across + p.y * p.y < 0.5f ? 1 : 0;
        sum += p;
    }
    CHECK(inner / double{kCount} == test::near(0.5).epsilon(0.02));
    CHECK(glm::length(sum) / kCount < 0.1f);
}

TEST_CASE(
    "particles: a shell's radii vary by axis, and an axis of 0 leaves a ring"
    * technique("engine.particle-params")) {
    Emitters scene;
    ParticleEmitter emitter = burst(20000);
    emitter.shape = EmitterShape::Sphere;
    emitter.size = {10, 10, 0};
    emitter.size_spread = {1, 1, 1};
    emitter.speed = 0;
    scene.add(emitter, falling(0));
    scene.run();
    const ParticlePool& pool = scene.pool();
    REQUIRE(pool.size() == 20000);
    const float spread = std::sqrt(2.0f);
    float thick = 0;
    float nearest = 20;
    float farthest = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        const float radius = std::sqrt(pool.x[i] * pool.x[i] + pool.y[i] * pool.y[i]);
        nearest = std::min(nearest, radius);
        farthest = std::max(farthest, radius);
        thick = std::max(thick, std::abs(pool.z[i]));
    }
    CHECK(nearest >= 10 - spread);
    CHECK(nearest < 10 - 0.9f * spread);
    CHECK(farthest <= 10 + spread);
    CHECK(farthest > 10 + 0.9f * spread);
    CHECK(thick <= 1);
    CHECK(thick > 0.99f);
}

TEST_CASE(
    "particles: velocities vary by axis, each by itself, and a small shell is a point"
    * technique("engine.particle-params")) {
    Emitters scene;
    ParticleEmitter emitter = burst(20000);
    emitter.shape = EmitterShape::Sphere;
    emitter.size = Vec3(0.001f);
    emitter.speed = 5;
    emitter.velocity_spread = {2, 1, 0.5f};
    scene.add(emitter, falling(0));
    scene.run();
    const ParticlePool& pool = scene.pool();
    const auto max_deviation = [](const std::vector<float>& v, float mean) {
        float largest = 0;
        double sum = 0;
        for (const float x : v) {
            largest = std::max(largest, std::abs(x - mean));
            sum += x;
        }
        CHECK(sum / static_cast<double>(v.size()) == near(mean).scale(1).epsilon(0.03));
        return largest;
    };
    CHECK(max_deviation(pool.vx, 0) == near(2).epsilon(0.001));
    CHECK(max_deviation(pool.vy, 5) == near(1).epsilon(0.001));
    CHECK(max_deviation(pool.vz, 0) == near(0.5).epsilon(0.001));
    double product = 0;
    for (std::size_t i = 0; i < pool.size(); ++i) {
        product += pool.vx[i] * (pool.vy[i] - 5);
    }
    CHECK(std::abs(product / 20000) < 0.02);
}

TEST_CASE(
    "particles: directions are unit, within the cone, even over its cap"
    * technique("particle.generation-shape")) {
    Random random(1, 2, 3, 4);
    constexpr int kCount = 50000;
    const float cone = 0.7f;
    const float halving = 0.5f * (1 + std::cos(cone));  // halves the cap's area
    int inner = 0;
    for (int i = 0; i < kCount; ++i) {
        const Vec3 v = sample_cone(cone, random);
        REQUIRE(std::abs(glm::length(v) - 1) < 1e-5f);
        REQUIRE(v.y >= std::cos(cone) - 1e-6f);
        inner += v.y > halving ? 1 : 0;
    }
    CHECK(inner / double{kCount} == test::near(0.5).epsilon(0.02));
}

TEST_CASE("particles: a prewarmed emitter starts as another is after that time") {
    Emitters scene;
    ParticleEmitter emitter = steady(60);
    emitter.life = 1;
    scene.add(emitter, falling());
    emitter.prewarm = 3;
    scene.add(emitter, falling());
    scene.run();
    CHECK(scene.pool(0).size() == 1);
    CHECK(scene.pool(1).size() == test::near(60).epsilon(0.04));
    CHECK(scene.pool(1).clock.time == test::near(3 + 1.0 / 60).epsilon(1e-3));
    scene.run(240);
    CHECK(
        scene.pool(0).size()
        == test::near(static_cast<double>(scene.pool(1).size())).epsilon(0.04));
    CHECK(scene.pool(1).clock.born == test::near(60 * 7).epsilon(0.02));
}

TEST_CASE(
    "particles: drops that waves throw up fly on from where they are, up to the capacity"
    * technique("water.crest-spray, water.impact-spray")) {
    Emitters scene;
    ParticleEmitter emitter = steady(0);
    emitter.capacity = 30;
    const Entity entity = scene.add(emitter, falling(0));
    scene.world.add(
        entity, SprayDrops{.drops = std::vector<SprayDrop>(20, {{1, 2, 3}, {6, 0, 0}})});
    scene.run();
    REQUIRE(scene.pool().size() == 20);
    for (std::size_t i = 0; i < 20; ++i) {
        CHECK(scene.pool().x[i] >= 1.0f);
        CHECK(scene.pool().x[i] <= 1 + 6 * kStep + 1e-5f);
        CHECK(scene.pool().x[i] - 1 == test::near(6 * scene.pool().age[i]).scale(1).epsilon(1e-5));
        CHECK(scene.pool().y[i] == 2.0f);
    }
    CHECK(scene.pool().x[0] != scene.pool().x[1]);
    scene.world.get<ParticleEmitter>(entity).drop_speed = 2;
    scene.run();
    CHECK(scene.pool().size() == 30);
    CHECK(scene.pool().clock.dropped == 10);
    CHECK(scene.pool().vx[0] == 6.0f);
    CHECK(scene.pool().vx.back() == 12.0f);
}

TEST_CASE("particles: a moving emitter leaves no gaps, and gives on its velocity") {
    Emitters scene;
    ParticleEmitter emitter = steady(10 / kStep);
    emitter.speed = 0;
    emitter.inherit = 0;
    const Entity entity = scene.add(emitter, falling(0));
    const auto at_x = [](float x) { return affine_from({x, 0, 0}, Quat(1, 0, 0, 0), Vec3(1)); };
    scene.world.get<WorldTransform>(entity).world = at_x(6);
    scene.world.get<PreviousWorldTransform>(entity).world = at_x(5);
    scene.run();
    REQUIRE(scene.pool().size() == 10);
    for (std::size_t i = 0; i < 10; ++i) {
        CHECK(scene.pool().x[i] == test::near(5.1 + 0.1 * static_cast<double>(i)));
    }
    scene.world.get<ParticleEmitter>(entity).inherit = 0.5f;
    scene.run();
    CHECK(scene.pool().vx.back() == test::near(30));  // of 60 m/s
}

TEST_CASE("particles: the curves of births are those of the library") {
    double turn_error = 0;
    double root_error = 0;
    double exp_error = 0;
    constexpr int kSteps = 1 << 20;
    for (int i = 0; i <= kSteps; ++i) {
        const float x = static_cast<float>(i) / kSteps;
        const double exact = static_cast<double>(x);
        const TurnPoint at = turn_point(x);
        const double angle = 2 * 3.14159265358979323846 * exact;
        turn_error =
            std::max(turn_error, std::abs(static_cast<double>(at.cosine) - std::cos(angle)));
        turn_error = std::max(turn_error, std::abs(static_cast<double>(at.sine) - std::sin(angle)));
        const double root = std::cbrt(exact);
        root_error = std::max(root_error, std::abs(static_cast<double>(cube_root(x)) - root));
        const double power = std::exp(exact);
        exp_error =
            std::max(exp_error, std::abs(static_cast<double>(exp_of_fraction(x)) / power - 1));
    }
    CHECK(turn_error < 2e-7);
    CHECK(root_error < 2e-7);
    CHECK(exp_error < 4e-7);
    CHECK(cube_root(0) < 1e-13f);
    CHECK(exp_of_fraction(0) == 1);
}

namespace {

/// Every attribute at random but for shape and direction.
ParticleEmitter varied(EmitterShape shape, EmitterDirection direction) {
    ParticleEmitter emitter;
    emitter.shape = shape;
    emitter.size = {0.5f, 2, 3};
    emitter.direction = direction;
    emitter.cone = 1.1f;
    emitter.speed = 4;
    emitter.speed_spread = 2;
    emitter.life = 3;
    emitter.life_spread = 1;
    return emitter;
}

/// Checks the births 0 .. count - 1 of a run against those drawn one by one.
void check_births(const BirthDraw& draw, const BirthRun& run, std::uint64_t number) {
    const auto count = static_cast<std::size_t>(run.count);
    std::vector<float> floats(8 * (count + 1), -7.0f);
    std::vector<std::uint32_t> looks(count + 1, 77);
    float* const f = floats.data();
    const auto column = [&](std::size_t c) { return f + c * (count + 1); };
    const std::size_t drawn = draw_births(
        draw, run, 0, count, number,
        {column(0), column(1), column(2), column(3), column(4), column(5), column(6), column(7),
         looks.data()});
    CHECK(drawn + 16 > count);
    for (std::size_t i = 0; i < drawn; ++i) {
        CAPTURE(i);
        const Newborn one = draw_birth(draw, run.at(static_cast<std::uint32_t>(i)), number + i);
        const float expected[] = {one.position.x, one.position.y, one.position.z, one.velocity.x,
                                  one.velocity.y, one.velocity.z, one.age,        one.life};
        for (std::size_t c = 0; c < 8; ++c) {
            CAPTURE(c);
            REQUIRE(std::memcmp(&expected[c], column(c) + i, sizeof(float)) == 0);
        }
        REQUIRE(one.look == looks[i]);
    }
    for (std::size_t c = 0; c < 8; ++c) {
        CHECK(column(c)[count] == -7.0f);
    }
    CHECK(looks[count] == 77);
}

}  // namespace

TEST_CASE(
    "particles: births in vectors have the bits of those drawn one by one"
    * technique("particle.generation-shape")) {
    const EmitterPose still = {
        affine_from({1, 2, 3}, Quat(0.8f, 0, 0.6f, 0), {1, 2, 0.5f}),
        affine_from({1, 2, 3}, Quat(0.8f, 0, 0.6f, 0), {1, 2, 0.5f})};
    EmitterPose moving = still;
    moving.now = affine_from({2, 2, 4}, Quat(0.6f, 0, 0, 0.8f), {1, 1, 1});
    const ParticleStep fall = {
        .gravity = {0.1f, -9.8f, 0}, .air = {3, 0, 1}, .keep = 0.9f, .dt = 0.02f};
    for (int shape = 0; shape <= static_cast<int>(EmitterShape::Torus); ++shape) {
        for (const EmitterDirection direction :
             {EmitterDirection::Cone, EmitterDirection::Radial}) {
            for (const std::uint32_t count : {0u, 1u, 5u, 16u, 33u, 1000u}) {
                CAPTURE(shape);
                CAPTURE(static_cast<int>(direction));
                CAPTURE(count);
                ParticleEmitter emitter = varied(static_cast<EmitterShape>(shape), direction);
                const BirthRun run = {.first = 0.01f, .spacing = 0.0013f, .count = count};
                check_births(
                    {&emitter, still, false, Rewind({.dt = 0.02f}), {0, 0, 0}, 5, 6}, run, 100);
                emitter.size_spread = {0.1f, 0, 0.2f};
                emitter.velocity_spread = {1, 2, 0};
                if (count > 5) {
                    emitter.size.z = 0;
                }
                check_births(
                    {&emitter, moving, true, Rewind(fall), {1, 0, -2}, 5, 6ull << 33}, run,
                    7ull << 32);
            }
        }
    }
}

TEST_CASE("particles: the number of a birth may pass 32 bits between births of a vector") {
    const std::uint64_t last = (std::uint64_t{1} << 32) - 3;
    ParticleEmitter emitter = varied(EmitterShape::Ball, EmitterDirection::Cone);
    const std::vector<BirthRun> births = {{.first = 0.5f, .count = 20}};
    ParticlePool pool;
    pool.clock.born = last;
    add_particles(emitter, {}, {.dt = 0.02f}, nullptr, 1, 2, births, pool);
    REQUIRE(pool.size() == 20);
    CHECK(pool.clock.born == last + 20);
    const BirthDraw draw = {&emitter, {}, false, Rewind({.dt = 0.02f}), {0, 0, 0}, 1, 2};
    for (std::size_t i = 0; i < 20; ++i) {
        CAPTURE(i);
        CHECK(pool.look[i] == draw_birth(draw, 0.5f, last + i).look);
    }
}

TEST_CASE("particles: births that are not finite are left out, their neighbors are not") {
    ParticleEmitter emitter = varied(EmitterShape::Box, EmitterDirection::Cone);
    emitter.life = 3e38f;
    emitter.life_spread = 1e38f;  // beyond the largest float for some
    ParticlePool pool;
    add_particles(
        emitter, {}, {.dt = 0.02f}, nullptr, 1, 2, {{.first = 0.5f, .count = 1000}}, pool);
    std::vector<std::uint32_t> expected;
    const BirthDraw draw = {&emitter, {}, false, Rewind({.dt = 0.02f}), {0, 0, 0}, 1, 2};
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const Newborn one = draw_birth(draw, 0.5f, i);
        if (one.is_finite()) {
            expected.push_back(one.look);
        }
    }
    CHECK(expected.size() > 600);
    CHECK(expected.size() < 900);
    CHECK(pool.look == expected);
    CHECK(pool.clock.born == 1000);
}

}  // namespace limn::particle_births_test
