#include "ecs/base/jobs.h"
#include "systems/water/ocean_system.h"
#include "systems/water/water_query.h"
#include "systems/water/water_ripple_field.h"
#include "systems/water/water_wave_table.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <random>

namespace limn::water_query_test {

namespace {

constexpr float kStep = 1.0f / 60;

/// Water with everything that moves water, at a moment. The pool is turned and away from the
/// origin.
struct Sea {
    explicit Sea(double time = 3.0) {
        surface.water = {.size = {24, 18}, .depth = 3};
        surface.frame.origin = {4, 1.5f, -7};
        surface.frame.along_x = {std::cos(0.6f), std::sin(0.6f)};
        fill_wave_table(surface.water, wave_settings(), time, waves);
        surface.waves = &waves;
    }
    static WaterWaves wave_settings() {
        WaterWaves settings;
        settings.waves = {
            {.amplitude = 0.25f, .length = 9, .direction = 0.4f, .sharpness = 1.0f},
            {.amplitude = 0.1f, .length = 4, .direction = -0.9f, .sharpness = 1.5f}};
        settings.radial = {{.center = {20, 1}, .amplitude = 0.05f, .length = 3, .fade_radius = 1}};
        return settings;
    }
    void add_ripples() {
        ripples = make_ripples(surface.water, settings, kStep);
        push_ripples(ripples, {.center = {1, 2}, .radius = 2.5f, .height = 0.3f});
        for (int i = 0; i < 30; ++i) {
            step_ripples(ripples, settings, kStep);
        }
        surface.ripples = &ripples;
    }
    void add_ocean(double time = 3.0) {
        step_ocean(sea, time, kStep, ocean);
        surface.ocean = &ocean;
    }
    /// An ocean of a single wave, sharp enough to matter, on a coarse grid.
    void add_swell() {
        OceanCascade& cascade = ocean.cascades.emplace_back();
        cascade.size = 32;
        cascade.patch = 16;
        const Vec2 k = 2 * kPi / cascade.patch * Vec2(2, 1);
        const Vec2 along = k / glm::length(k);
        const float height = 0.15f;
        for (int z = 0; z < 32; ++z) {
            for (int x = 0; x < 32; ++x) {
                const float phase = glm::dot(k, 0.5f * Vec2(x, z));
                const float sine = height * std::sin(phase);
                const float cosine = height * std::cos(phase);
                cascade.height.push_back(cosine);
                cascade.shift_x.push_back(-along.x * sine);
                cascade.shift_z.push_back(-along.y * sine);
                cascade.slope_x.push_back(-k.x * sine);
                cascade.slope_z.push_back(-k.y * sine);
                cascade.shift_xx.push_back(-along.x * k.x * cosine);
                cascade.shift_zz.push_back(-along.y * k.y * cosine);
                cascade.shift_xz.push_back(-along.x * k.y * cosine);
            }
        }
        surface.ocean = &ocean;
    }
    /// A position over the water, in the world; at least a meter from its edges.
    [[nodiscard]] Vec2 random_place(std::mt19937& random) const {
        std::uniform_real_distribution<float> fraction(-0.5f, 0.5f);
        const Vec2 size = surface.water.size - 2.0f;
        const Vec3 at =
            surface.frame.world({fraction(random) * size.x, 0, fraction(random) * size.y});
        return {at.x, at.z};
    }

    WaterRipples settings{.cell = 0.1f};
    Ocean sea{.cascades = 2, .patch = 60, .resolution = 64};
    WaveTable waves;
    RippleState ripples;
    OceanState ocean;
    WaterSurface surface;
};

float height_at(const WaterSurface& surface, const Vec2& at) {
    return sample_water(surface, at).position.y;
}

}  // namespace

TEST_CASE("water query: the result is on the surface, above the queried position") {
    Sea sea;
    sea.add_ripples();
    sea.add_ocean();
    std::mt19937 random(1);
    int evaluations = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec2 at = sea.random_place(random);
        const WaterPoint point = sample_water(sea.surface, at);
        REQUIRE(point.is_water);
        const Vec3 drawn = sea.surface.frame.world(
            Vec3(point.rest.x, 0, point.rest.y) + displace_water(sea.surface, point.rest).offset);
        CHECK(glm::distance(point.position, drawn) < 1e-5f);
        CHECK(glm::distance(Vec2(point.position.x, point.position.z), at) < 1.2e-4f);
        CHECK(std::abs(point.error - glm::distance(Vec2(drawn.x, drawn.z), at)) < 1e-5f);
        CHECK(glm::length(point.normal) == test::near(1));
        evaluations += point.evaluations;
        CHECK(point.evaluations <= 12);
    }
    CHECK(evaluations < 5 * 1000);
}

TEST_CASE("water query: still water takes one evaluation, and is level and at rest") {
    WaterSurface surface;
    surface.frame.origin.y = 2;
    const WaterPoint point = sample_water(surface, {100, -40});
    CHECK(point.is_water);
    CHECK(point.position == Vec3(100, 2, -40));
    CHECK(point.normal == Vec3(0, 1, 0));
    CHECK(point.velocity == Vec3(0));
    CHECK(point.evaluations == 1);
}

TEST_CASE("water query: without horizontal shift a position is its own rest point") {
    Sea sea;
    sea.waves.lines.clear();
    sea.add_ripples();
    std::mt19937 random(2);
    for (int i = 0; i < 100; ++i) {
        const Vec2 at = sea.random_place(random);
        const WaterPoint point = sample_water(sea.surface, at);
        CHECK(point.evaluations == 1);
        const Vec3 rest = sea.surface.frame.world({point.rest.x, 0, point.rest.y});
        CHECK(glm::distance(Vec2(rest.x, rest.z), at) < 1e-5f);
    }
}

TEST_CASE("water query: normals match the surrounding heights, also of sharp waves") {
    Sea sea;
    std::mt19937 random(3);
    const float h = 0.02f;
    for (int i = 0; i < 300; ++i) {
        const Vec2 at = sea.random_place(random);
        const WaterPoint point = sample_water(sea.surface, at);
        const float by_x =
            (height_at(sea.surface, at + Vec2(h, 0)) - height_at(sea.surface, at - Vec2(h, 0)))
            / (2 * h);
        const float by_z =
            (height_at(sea.surface, at + Vec2(0, h)) - height_at(sea.surface, at - Vec2(0, h)))
            / (2 * h);
        CHECK(glm::distance(point.normal, glm::normalize(Vec3(-by_x, 1, -by_z))) < 0.01f);
        CHECK(std::abs(point.slope().x - by_x) < 0.015f);
        CHECK(std::abs(point.slope().y - by_z) < 0.015f);
    }
}

TEST_CASE("water query: normals of ripples and of the ocean match the surrounding heights") {
    Sea sea;
    sea.waves = {};
    std::mt19937 random(4);
    const auto check = [&](float h, double tolerance) {
        double error2 = 0;
        double slope2 = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec2 at = sea.random_place(random);
            const auto across = [&](const Vec2& step) {
                return (height_at(sea.surface, at + step) - height_at(sea.surface, at - step))
                       / (2 * h);
            };
            const Vec2 numeric = {across({h, 0}), across({0, h})};
            const Vec2 error = sample_water(sea.surface, at).slope() - numeric;
            error2 += static_cast<double>(glm::dot(error, error));
            slope2 += static_cast<double>(glm::dot(numeric, numeric));
        }
        CHECK(slope2 / 300 > 1e-4);
        CHECK(error2 < tolerance * tolerance * slope2);
    };
    sea.add_ripples();
    check(0.1f, 0.15);
    sea.surface.ripples = nullptr;
    sea.add_swell();
    check(0.5f, 0.05);
}

TEST_CASE("water query: at its grid points the ocean has the values of its grids, and it repeats") {
    Sea sea;
    sea.waves = {};
    sea.surface.water = {};
    sea.add_ocean();
    const float patch = sea.ocean.cascades[0].patch;
    sea.ocean.cascades.resize(1);
    const OceanCascade& cascade = sea.ocean.cascades[0];
    const float cell = patch / static_cast<float>(cascade.size);
    for (const IVec2 point : {IVec2(0, 0), IVec2(5, 2), IVec2(63, 63), IVec2(63, 0)}) {
        const auto i = static_cast<std::size_t>(point.y * cascade.size + point.x);
        const Vec3 offset = {cascade.shift_x[i], cascade.height[i], cascade.shift_z[i]};
        const WavePoint found = displace_water(sea.surface, cell * Vec2(point));
        CHECK(glm::distance(found.offset, offset) < 1e-4f);
        CHECK(std::abs(found.by_x.y - cascade.slope_x[i]) < 1e-4f);
        CHECK(std::abs(found.by_z.x - cascade.shift_xz[i]) < 1e-4f);
        const Vec2 far = cell * Vec2(point) + patch * Vec2(-3, 2);
        CHECK(glm::distance(displace_water(sea.surface, far).offset, offset) < 1e-3f);
    }
    // Halfway along an edge: the mean of its ends.
    const Vec3 midpoint = displace_water(sea.surface, {cell * 63.5f, 0}).offset;
    CHECK(midpoint.y == test::near(0.5f * (cascade.height[63] + cascade.height[0])));
}

TEST_CASE("water query: heights change by velocity and slope") {
    // At a fixed position, dh/dt = v_y - v_xz . slope.
    const float dt = 0.01f;
    Sea sea(3.0);
    const Sea before(3.0 - static_cast<double>(dt));
    const Sea after(3.0 + static_cast<double>(dt));
    std::mt19937 random(5);
    for (int i = 0; i < 300; ++i) {
        const Vec2 at = sea.random_place(random);
        const WaterPoint point = sample_water(sea.surface, at);
        const float rise =
            (height_at(after.surface, at) - height_at(before.surface, at)) / (2 * dt);
        const Vec2 slope = point.slope();
        const float expected =
            point.velocity.y - point.velocity.x * slope.x - point.velocity.z * slope.y;
        CHECK(std::abs(rise - expected) < 0.02f);
    }
}

TEST_CASE("water query: the velocity of the ocean is its displacement in the last step") {
    Sea now(3.0);
    Sea before(3.0 - static_cast<double>(kStep));
    for (Sea* sea : {&now, &before}) {
        sea->waves = {};
    }
    now.add_ocean(3.0);
    before.add_ocean(3.0 - static_cast<double>(kStep));
    std::mt19937 random(6);
    for (int i = 0; i < 100; ++i) {
        const Vec2 rest = now.random_place(random);
        const Vec3 moved =
            displace_water(now.surface, rest).offset - displace_water(before.surface, rest).offset;
        CHECK(glm::distance(displace_water(now.surface, rest).velocity, moved / kStep) < 1e-2f);
    }
}

TEST_CASE("water query: it converges everywhere on the sharpest waves, cusps") {
    WaterSurface surface;
    WaveTable waves;
    const float length = 10;
    const float amplitude = 0.5f;
    fill_wave_table(
        {},
        {.waves =
             {{.amplitude = amplitude,
               .length = length,
               .sharpness = length / (2 * kPi * amplitude)}}},
        0.7, waves);
    surface.waves = &waves;
    int most = 0;
    for (int i = 0; i < 2000; ++i) {
        const WaterPoint point = sample_water(surface, {0.01f * static_cast<float>(i), 0});
        CHECK(point.error < 2e-4f);
        CHECK(std::isfinite(point.normal.x + point.slope().x));
        most = std::max(most, point.evaluations);
    }
    CHECK(most <= 20);
}

TEST_CASE("water query: on folded water it finds one of the solutions") {
    Sea sea;
    sea.sea = {.wind_speed = 25, .choppiness = 4, .cascades = 3, .patch = 100, .resolution = 64};
    sea.add_ocean();
    std::mt19937 random(7);
    int found = 0;
    for (int i = 0; i < 500; ++i) {
        const WaterPoint point = sample_water(sea.surface, sea.random_place(random));
        CHECK(point.evaluations <= 32);
        CHECK(std::isfinite(point.position.y + point.normal.y + point.velocity.y));
        CHECK(point.normal.y >= 0);
        found += point.error < 1e-3f ? 1 : 0;
    }
    CHECK(found > 450);
}

TEST_CASE("water query: beyond the edge, and at NaN positions, there is no water") {
    const Sea sea;
    const auto at = [&](float x, float z) {
        const Vec3 world = sea.surface.frame.world({x, 0, z});
        return sample_water(sea.surface, {world.x, world.z}).is_water;
    };
    CHECK(at(11.99f, 8.99f));
    CHECK(!at(12.01f, 0));
    CHECK(!at(0, -9.01f));
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    CHECK(!sample_water(sea.surface, {kNan, 0}).is_water);
    CHECK(!sample_water({}, {0, kInfinity}).is_water);
    CHECK(!find_water({&sea.surface, 1}, {0, kNan, 0}));
    CHECK(!find_water({}, {0, 0, 0}));
    // A window of ripples is no edge: around it the water is still.
    WaterSurface open;
    RippleState ripples = make_ripples({}, {.window = {2, 2}}, kStep);
    push_ripples(ripples, {.radius = 1, .height = 0.2f});
    open.ripples = &ripples;
    CHECK(height_at(open, {0, 0}) > 0.1f);
    CHECK(sample_water(open, {1.5f, 0}).is_water);
    CHECK(height_at(open, {1.5f, 0}) == 0);
}

TEST_CASE("water query: many positions at once give the same results, on any number of threads") {
    Sea sea;
    sea.add_ripples();
    sea.add_ocean();
    std::mt19937 random(8);
    std::vector<Vec2> places;
    for (int i = 0; i < 500; ++i) {
        places.push_back(1.2f * sea.random_place(random));
    }
    const int threads = thread_count();
    for (const int count : {1, 2, 5}) {
        set_thread_count(count);
        std::vector<WaterPoint> points(places.size());
        sample_waters(sea.surface, places, points);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const WaterPoint one = sample_water(sea.surface, places[i]);
            CHECK(points[i].is_water == one.is_water);
            CHECK(points[i].position == one.position);
            CHECK(points[i].velocity == one.velocity);
        }
    }
    set_thread_count(threads);
}

TEST_CASE("water query: a point is in the water whose surface is nearest above it") {
    const WaterSurface high = {
        .frame = {.origin = {0, 5, 0}}, .water = {.size = {4, 4}, .depth = 1}};
    const WaterSurface low = {.frame = {.origin = {0, 0, 0}}, .water = {}};
    const WaterSurface both[] = {low, high};
    const auto in_high = find_water(both, {1, 4.5f, 1});
    REQUIRE(in_high);
    CHECK(in_high->index == 1);
    CHECK(in_high->depth == test::near(0.5));
    CHECK(!find_water(both, {1, 3.5f, 1}));  // below the bottom of one, above the other
    CHECK(!find_water(both, {3, 4.5f, 1}));
    const auto in_low = find_water(both, {1, -100, 1});
    REQUIRE(in_low);
    CHECK(in_low->index == 0);
    CHECK(in_low->depth == test::near(100));
    const WaterSurface higher = {.frame = {.origin = {0, 9, 0}}, .water = {}};
    const WaterSurface three[] = {higher, low, high};
    CHECK(find_water(three, {1, 4.5f, 1})->index == 2);
    CHECK(find_water(three, {1, -1, 1})->index == 1);
    CHECK(find_water(three, {1, 3, 1})->index == 0);
    CHECK(water_bottom(high) == 4);
    CHECK(water_bottom(low) < -1e30f);
}

TEST_CASE("water query: waves shorter than a given length can be omitted") {
    Sea sea;
    sea.surface.min_wavelength = 6;
    const WaveTable all = sea.waves;
    sea.waves.rings.clear();
    sea.waves.lines.resize(1);  // that of 9 m
    const Vec3 alone = evaluate_waves(sea.waves, {1, 2}).offset;
    sea.waves = all;
    CHECK(displace_water(sea.surface, {1, 2}).offset == alone);
    sea.surface.min_wavelength = 10;
    CHECK(displace_water(sea.surface, {1, 2}).offset == Vec3(0));
    sea.surface.min_wavelength = 0;
    CHECK(displace_water(sea.surface, {1, 2}).offset == evaluate_waves(all, {1, 2}).offset);
}

TEST_CASE("water query: a ray hits the water at a point on both") {
    Sea sea;
    sea.add_ripples();
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 200; ++i) {
        const Vec2 at = sea.random_place(random);
        const Vec3 target = {at.x, height_at(sea.surface, at), at.y};
        const Vec3 up =
            glm::normalize(Vec3(normal(random), 1.5f + std::abs(normal(random)), normal(random)));
        const Vec3 eye = target + 30.0f * up;
        const auto hit = hit_water(sea.surface, eye, -up, 100);
        if (!hit) {
            continue;
        }
        const Vec3 aside = glm::cross(hit->position - eye, up);
        CHECK(glm::length(aside) < 5e-3f);
        CHECK(glm::distance(hit->position, target) < 5e-2f);
    }
    CHECK(!hit_water(sea.surface, {4, 5, -7}, {0, 1, 0}, 100));
    CHECK(!hit_water(sea.surface, {4, 5, -7}, {1, 0, 0}, 100));
    CHECK(!hit_water(sea.surface, {4, 5, -7}, {0, -1, 0}, 2));
    CHECK(!hit_water(sea.surface, {40, 5, -7}, {0, -1, 0}, 100));
    CHECK(hit_water(sea.surface, {4, 5, -7}, {0, -1, 0}, 100));
}

}  // namespace limn::water_query_test
