#include "ecs/base/rng.h"
#include "systems/particles/particle_collision_kernels.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <hwy/targets.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace limn::particle_collision_kernels_test {

using namespace limn::test;

namespace {

constexpr SurfaceResponse kResponse = {.bounce = 0.6f, .friction = 0.9f};
constexpr float kRadius = 0.05f;

struct Arrays {
    std::vector<float> px, py, pz, vx, vy, vz;

    explicit Arrays(std::size_t count) {
        Random random(4, 3, 2, 1);
        for (auto* column : {&px, &py, &pz, &vx, &vy, &vz}) {
            for (std::size_t i = 0; i < count; ++i) {
                column->push_back(random.uniform(-3.0f, 3.0f));
            }
        }
    }
    ParticleColumns columns() { return {px, py, pz, vx, vy, vz}; }
    std::vector<std::uint32_t> bits() const {
        std::vector<std::uint32_t> all;
        for (const auto* column : {&px, &py, &pz, &vx, &vy, &vz}) {
            for (const float value : *column) {
                all.push_back(std::bit_cast<std::uint32_t>(value));
            }
        }
        return all;
    }
    Vec3 position(std::size_t i) const { return {px[i], py[i], pz[i]}; }
    Vec3 velocity(std::size_t i) const { return {vx[i], vy[i], vz[i]}; }
};

const std::vector<float>& heights() {
    static const std::vector<float> made = [] {
        std::vector<float> values;
        Random random(7, 7, 7, 7);
        for (int i = 0; i < 11 * 7; ++i) {
            values.push_back(random.uniform(-1.0f, 1.0f));
        }
        return values;
    }();
    return made;
}

struct Case {
    const char* name;
    Collider collider;
    void (*vector)(const ParticleColumns&, const Collider&);
    void (*scalar)(const ParticleColumns&, const Collider&);
};

template <typename Shape, auto vector, auto scalar>
Case make_case(const char* name, const Shape& shape) {
    return {
        name, shape,
        [](const ParticleColumns& p, const Collider& collider) {
            vector(p, std::get<Shape>(collider), kResponse, kRadius);
        },
        [](const ParticleColumns& p, const Collider& collider) {
            scalar(p, std::get<Shape>(collider), kResponse, kRadius);
        }};
}

std::vector<Case> make_cases() {
    return {
        make_case<PlaneCollider, collide_plane, collide_plane_scalar>(
            "plane", PlaneCollider{.normal = {1, 2, -1}, .offset = 0.25f}),
        make_case<SphereCollider, collide_sphere, collide_sphere_scalar>(
            "sphere", SphereCollider{.center = {0.5f, 0, 0.25f}, .radius = 2}),
        make_case<SphereCollider, collide_sphere, collide_sphere_scalar>(
            "hollow", SphereCollider{.center = {0.5f, 0, 0.25f}, .radius = 2, .inverted = true}),
        make_case<HeightCollider, collide_height_field, collide_height_field_scalar>(
            "height field", HeightCollider{
                                .origin = {-2.5f, 0, -1.5f},
                                .cell = {0.5f, 0.6f},
                                .width = 11,
                                .depth = 7,
                                .heights = heights()})};
}

}  // namespace

TEST_CASE("particle collision: kernels give the same bits on every vector width") {
    for (const Case& each : make_cases()) {
        CAPTURE(each.name);
        for (const std::size_t count : {std::size_t{0}, std::size_t{5}, std::size_t{1003}}) {
            Arrays expected(count);
            each.scalar(expected.columns(), each.collider);
            for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
                hwy::SetSupportedTargetsForTest(target);
                Arrays found(count);
                each.vector(found.columns(), each.collider);
                CHECK(found.bits() == expected.bits());
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST_CASE(
    "particle collision: kernels push out and respond as one particle at a time does"
    * technique("particle.constraints")) {
    for (const Case& each : make_cases()) {
        CAPTURE(each.name);
        Arrays found(2000);
        const Arrays before = found;
        each.vector(found.columns(), each.collider);
        int inside = 0;
        for (std::size_t i = 0; i < before.px.size(); ++i) {
            const bool is_field = std::holds_alternative<HeightCollider>(each.collider);
            const Vec3 lift = is_field ? Vec3(0, kRadius, 0) : Vec3(0);  // raised, not grown
            const auto out =
                find_escape(each.collider, before.position(i) - lift, is_field ? 0.0f : kRadius);
            const Vec3 to = out ? out->point + lift : before.position(i);
            const Vec3 v =
                out ? respond(before.velocity(i), out->normal, kResponse) : before.velocity(i);
            inside += out ? 1 : 0;
            CHECK(glm::distance(found.position(i), to) < 1e-5f);
            CHECK(glm::distance(found.velocity(i), v) < 1e-4f);
        }
        CHECK(inside > 100);
    }
}

TEST_CASE("particle collision: kernels find particles just below the highest point of a field") {
    // Almost level: many are near the highest point, some above and some below the surface.
    std::vector<float> level(121);
    Random random(5, 5, 5, 5);
    for (float& height : level) {
        height = random.uniform(99.99997f, 100.0f);
    }
    const HeightCollider field = {
        .origin = {-3, -0.3f, -3},
        .cell = {0.6f, 0.6f},
        .width = 11,
        .depth = 11,
        .heights = level};
    Arrays found(4000);
    for (float& y : found.py) {
        y = 99.7f + random.uniform(-3e-5f, 3e-5f);
    }
    Arrays expected = found;
    const std::vector<std::uint32_t> before = found.bits();
    collide_height_field(found.columns(), field, kResponse);
    collide_height_field_scalar(expected.columns(), field, kResponse);
    CHECK(found.bits() == expected.bits());
    CHECK(found.bits() != before);
}

TEST_CASE("particle collision: kernels leave NaN alone") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Case& each : make_cases()) {
        CAPTURE(each.name);
        Arrays arrays(35);
        arrays.px.assign(35, nan);
        arrays.pz.assign(35, nan);
        const auto before = arrays.bits();
        each.vector(arrays.columns(), each.collider);
        CHECK(arrays.bits() == before);
    }
}

}  // namespace limn::particle_collision_kernels_test
