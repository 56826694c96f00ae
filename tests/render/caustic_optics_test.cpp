#include "ecs/base/caustic_optics.h"
#include "ecs/base/optics.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace limn::test::caustic_optics_test {
namespace {

constexpr float kIndex = 1.33f;
const Vec3 kUp = {0, 1, 0};

/// Bottom and four walls.
std::array<Plane, 5> pool_planes(const Vec2& half, float depth) {
    return {
        {{{0, 1, 0}, -depth},
         {{1, 0, 0}, half.x},
         {{-1, 0, 0}, half.x},
         {{0, 0, 1}, half.y},
         {{0, 0, -1}, half.y}}};
}

/// Somewhere in a pool of half extents 2 and 3, and a ray down from there.
Vec3 start_of(int i) {
    const auto n = static_cast<float>(i);
    return {1.9f * std::sin(1.7f * n), 0.1f * std::sin(3.1f * n), 2.9f * std::cos(2.3f * n)};
}
Vec3 ray_of(int i) {
    const auto n = static_cast<float>(i);
    return glm::normalize(Vec3(std::sin(0.9f * n), -0.3f, std::cos(1.3f * n)));
}

/// Area that a square patch of a lens y = bulge * r^2 lights on the bottom, over its own.
float lit_area(float bulge) {
    const auto lands = [&](float x, float z) {
        const Vec3 normal = glm::normalize(Vec3(-2 * bulge * x, 1, -2 * bulge * z));
        const Vec3 from(x, bulge * (x * x + z * z), z);
        const Plane bottom = {kUp, -2};
        return hit_nearest_plane(from, refract_ray(normal, kUp, 1 / kIndex), {&bottom, 1});
    };
    const Vec3 a = lands(-0.5f, -0.5f);
    const Vec3 b = lands(0.5f, 0.5f);
    return (b.x - a.x) * (b.z - a.z);
}

/// A mirror of radius 1 about the y axis, lit along +x, at angle `a`.
struct Mirror {
    Vec3 at;
    Vec3 normal;
    Vec3 light;
};
Mirror mirror_at(float a) {
    const Vec3 at(std::cos(a), 0, std::sin(a));
    return {at, -at, at - Vec3(50, 0, 0)};
}

}  // namespace

TEST_CASE(
    "caustic optics: a ray hits a plane at the right distance, a parallel one never"
    * technique("caustic.projected-vertices")) {
    const Plane plane = {{0, 0, 1}, 0};
    CHECK(distance_to_plane({0, 0, 2}, {0, 0, -1}, plane) == test::near(2));
    CHECK(distance_to_plane({0, 0, 2}, {1, 0, 0}, plane) == kFarPlane);
    CHECK(distance_to_plane({0, 0, 2}, {0, 0, 1}, plane) == kFarPlane);
    for (const float x : {-1.0f, 0.0f, 1.0f}) {
        const Vec3 beside = hit_nearest_plane({x, 0, 2}, {1, 0, 0}, {&plane, 1});
        CHECK(std::isfinite(beside.x));
    }
}

TEST_CASE(
    "caustic optics: rays land on the nearest plane of a pool"
    * technique("caustic.projected-vertices")) {
    const std::array<Plane, 5> planes = pool_planes({2, 3}, 1.5f);
    for (int i = 0; i < 500; ++i) {
        const Vec3 from = start_of(i);
        const Vec3 ray = ray_of(i);
        const Vec3 hit = hit_nearest_plane(from, ray, planes);
        bool on_one = false;
        for (const Plane& plane : planes) {
            const float off = glm::dot(plane.normal, hit) - plane.offset;
            on_one = on_one || std::abs(off) < 1e-5f;
        }
        CHECK(on_one);
        CHECK(hit.y > -1.5f - 1e-5f);
        CHECK(std::abs(hit.x) < 2 + 1e-5f);
        CHECK(std::abs(hit.z) < 3 + 1e-5f);
    }
}

TEST_CASE(
    "caustic optics: ratios of areas conserve light, and flat water lights evenly"
    * technique("caustic.projected-vertices")) {
    const Plane bottom = {kUp, -2};
    const Vec3 to_sun = glm::normalize(Vec3(0.3f, 1, -0.2f));
    const auto moved = [&](float x, float z, float high) {
        const Vec3 normal = glm::normalize(Vec3(-high * std::cos(x), 1, high * std::sin(z)));
        const Vec3 from(x, high * (std::sin(x) + std::cos(z)), z);
        return hit_nearest_plane(from, refract_ray(normal, to_sun, 1 / kIndex), {&bottom, 1});
    };
    for (const float high : {0.0f, 0.1f}) {
        double entered = 0;
        double arrived = 0;
        for (int i = 0; i < 400; ++i) {
            const float x = 0.1f * static_cast<float>(i % 20);
            const float z = 0.1f * static_cast<float>(i / 20);
            const Vec3 a = moved(x, z, high);
            const Vec3 b = moved(x + 0.1f, z, high);
            const Vec3 c = moved(x, z + 0.1f, high);
            const float after = glm::length(glm::cross(b - a, c - a));
            const float light = irradiance_ratio(0.01f, after);
            if (high == 0) {
                CHECK(light == test::near(1).epsilon(1e-3));
            }
            entered += 0.01;
            arrived += static_cast<double>(after * light);
        }
        CHECK(arrived == test::near(entered).epsilon(1e-3));
    }
}

TEST_CASE(
    "caustic optics: a pool is as bright as the cube of the water's height"
    * technique("caustic.refraction-pool")) {
    const float least = -0.3f;
    const float scale = pool_scale(least, 0.5f);
    const auto at = [&](float fraction) {
        return pool_light(least + 0.8f * fraction, least, scale);
    };
    CHECK(at(0) == 0);
    CHECK(at(1) == test::near(1));
    CHECK(at(0.5f) == test::near(0.125));
    CHECK(at(0.75f) == test::near(0.421875));
    double sum = 0;
    float before = -1;
    for (int i = 0; i < 1000; ++i) {
        const float light = at((static_cast<float>(i) + 0.5f) / 1000);
        CHECK(light > before);
        before = light;
        sum += static_cast<double>(light);
    }
    CHECK(sum / 1000 == test::near(0.25).epsilon(1e-3));
    CHECK(pool_light_squared(0.5f, 0, pool_scale(0, 1)) == test::near(0.25));
    CHECK(pool_light(0.2f, 0.2f, pool_scale(0.2f, 0.2f)) == 0);  // still water
}

TEST_CASE(
    "caustic optics: crests focus light, troughs spread it, flat water does neither"
    * technique("caustic.refraction-pool")) {
    const Plane bottom = {kUp, -2};
    const Vec3 below =
        hit_nearest_plane({0.4f, 0, -0.7f}, refract_ray(kUp, kUp, 1 / kIndex), {&bottom, 1});
    CHECK(glm::length(below - Vec3(0.4f, -2, -0.7f)) < 1e-5f);
    CHECK(lit_area(-0.1f) < 0.95f);
    CHECK(lit_area(0.1f) > 1.05f);
    CHECK(lit_area(0) == test::near(1).epsilon(1e-4));
}

TEST_CASE(
    "caustic optics: a vertex reflects light onto a plane as in the book"
    * technique("caustic.reflection-plane")) {
    const Plane plane = {{0, 0, 1}, 0};
    const Vec3 vertex(1, 0, 1);
    const Vec3 l = glm::normalize(Vec3(1, 0, -1));
    const Vec3 light = vertex - 4.0f * l;
    const MirroredVertex moved = mirror_vertex(vertex, {-1, 0, 0}, light, plane);
    CHECK(glm::length(moved.position) < 1e-5f);
    CHECK(glm::distance(moved.position, vertex) == test::near(1.414214));
    CHECK(moved.light == test::near(0.125));
    const MirroredVertex text = mirror_vertex(
        vertex, {-1, 0, 0}, light, plane, {.plane_exponent = 1, .surface_exponent = 4});
    CHECK(text.light == test::near(0.176777));

    const MirroredVertex away = mirror_vertex(vertex, {1, 0, 0}, light, plane);
    CHECK(away.position == vertex);
    CHECK(away.light == 0);
    const MirroredVertex upward = mirror_vertex(vertex, {0, 0, 1}, light, plane);
    CHECK(glm::distance(upward.position, vertex) < 1e-6f);
    CHECK(upward.light == 0);
    // A ray that comes down too far away ends on the plane; one that must not lie so high is black.
    const Vec3 flat = glm::normalize(Vec3(-1, 0, -1e-4f));
    const Vec3 half = glm::normalize(flat - l);
    const MirroredVertex far = mirror_vertex(vertex, half, light, plane, {.max_distance = 10});
    CHECK(std::abs(far.position.z) < 1e-4f);
    CHECK(glm::distance(Vec2(far.position), Vec2(vertex)) < 11);
    const MirroredVertex high = mirror_vertex(
        {1, 0, 5}, half, Vec3(1, 0, 5) - 4.0f * l, plane, {.max_distance = 10, .max_height = 2});
    CHECK(high.light == 0);
    CHECK(std::abs(high.position.z) < 1e-4f);
}

TEST_CASE(
    "caustic optics: a round mirror's rays cross its axis at 1 / (2 cos a), and touch a nephroid"
    * technique("caustic.reflection-plane")) {
    const Plane axis = {{0, 0, 1}, 0};
    const float expected[][2] = {{1, 0.500076f}, {10, 0.507713f}, {30, 0.577350f}, {45, 0.707107f}};
    for (const auto& [degrees, crossing] : expected) {
        const Mirror mirror = mirror_at(radians(degrees));
        const MirroredVertex moved = mirror_vertex(mirror.at, mirror.normal, mirror.light, axis);
        CHECK(moved.position.x == test::near(crossing).epsilon(2e-4));
    }
    constexpr float kStep = 0.01f;
    for (float a = 0.05f; a < 1.4f; a += 0.1f) {
        // Where two neighbors meet, their light is densest.
        const Mirror one = mirror_at(a);
        const Mirror two = mirror_at(a + kStep);
        const Vec3 d = reflect_ray(one.normal, {-1, 0, 0});
        const Vec3 e = reflect_ray(two.normal, {-1, 0, 0});
        const Vec3 between = two.at - one.at;
        const float path = (between.x * e.z - between.z * e.x) / (d.x * e.z - d.z * e.x);
        const Vec3 meet = one.at + path * d;
        const float t = a + 0.5f * kStep;
        CHECK(meet.x == test::near((3 * std::cos(t) - std::cos(3 * t)) / 4).epsilon(0.01));
        CHECK(std::abs(meet.z - (3 * std::sin(t) - std::sin(3 * t)) / 4) < 0.01f);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "caustic optics: the GLSL functions equal the C++ ones"
                    * technique("caustic.reflection-plane, caustic.refraction-pool")) {
    std::vector<Vec4> mirrors;
    for (int i = 0; i < 256; ++i) {
        mirrors.emplace_back(start_of(i), static_cast<float>(i));
    }
    const std::vector<Vec4> sent = evaluate_shader(
        "#include \"lib/caustic_landing.glsl\"\n",
        "vec3 normal = normalize(vec3(sin(0.9 * x.w), -0.3, cos(1.3 * x.w)));\n"
        "y = mirror_vertex(x.xyz, normal, vec4(1.0, 4.0, 2.0, 1.0), vec4(0.0, 1.0, 0.0, -1.5),"
        " vec4(1.0, 4.0, 20.0, 1e6));",
        mirrors);
    for (int i = 0; i < 256; ++i) {
        const MirroredVertex expected = mirror_vertex(
            start_of(i), ray_of(i), {1, 4, 2}, {{0, 1, 0}, -1.5f},
            {.plane_exponent = 1, .surface_exponent = 4, .max_distance = 20});
        const Vec4 found = sent[static_cast<std::size_t>(i)];
        CHECK(glm::distance(Vec3(found), expected.position) < 2e-3f);
        CHECK(std::abs(std::max(found.w, 0.0f) - expected.light) < 1e-4f);
    }
    std::vector<Vec4> inputs;
    for (int i = 0; i < 256; ++i) {
        inputs.emplace_back(start_of(i), static_cast<float>(i));
    }
    const std::vector<Vec4> hits = evaluate_shader(
        "#include \"lib/caustic_landing.glsl\"\n",
        "vec3 ray = normalize(vec3(sin(0.9 * x.w), -0.3, cos(1.3 * x.w)));\n"
        "y = vec4(land_in_pool(x.xyz, ray, vec2(2.0, 3.0), 1.5), pool_light(x.y, -0.1, 5.0));",
        inputs);
    const std::array<Plane, 5> planes = pool_planes({2, 3}, 1.5f);
    for (int i = 0; i < 256; ++i) {
        const Vec3 expected = hit_nearest_plane(start_of(i), ray_of(i), planes);
        CHECK(glm::distance(Vec3(hits[static_cast<std::size_t>(i)]), expected) < 1e-3f);
        CHECK(
            hits[static_cast<std::size_t>(i)].w
            == test::near(pool_light(start_of(i).y, -0.1f, 5)).epsilon(1e-4));
    }
}

}  // namespace limn::test::caustic_optics_test
