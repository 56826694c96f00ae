#include "ecs/components/all.h"
#include "ecs/components/height_fog.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <optional>

namespace limn::test::airlight_test {
namespace {

constexpr float kExtinction = 0.05f;

HeightFog lamp_fog(float forward, float scale_height = 1e5f) {
    return {
        .density = kExtinction,
        .base = 0,
        .scale_height = scale_height,
        .ambient = {0, 0, 0},
        .sun = 0,
        .forward = forward,
        .lamps = 1};
}

struct LampScene : Scene {
    LampScene() { world.insert_resource(FrameTime{}); }

    /// What the center pixel of a view along -z sees from the origin.
    float seen(const Vec3& toward = {0, 0, -1}) {
        return rgb_at(radiance(look({0, 0, 0}, toward, 33, 33)), 16, 16).x;
    }
};

/// Light of a spot at `position` along `axis`, unit, that fog of any height scatters toward the
/// origin from along `direction`, by many short steps in double precision.
double march(
    const SpotLight& spot, const glm::dvec3& position, const glm::dvec3& axis,
    const glm::dvec3& direction, const HeightFog& fog) {
    constexpr int kSteps = 4000;
    constexpr double kLength = 40;
    constexpr int kLampSteps = 200;
    const auto extinction = [&](const glm::dvec3& at) {
        return fog.density * std::exp(-(at.y - fog.base) / fog.scale_height);
    };
    double sum = 0;
    double passed = 1;
    for (int i = 0; i < kSteps; ++i) {
        const double step = kLength / kSteps;
        const glm::dvec3 at = (i + 0.5) * step * direction;
        const glm::dvec3 from_lamp = at - position;
        const double distance = glm::length(from_lamp);
        const double cosine = glm::dot(from_lamp / distance, axis);
        const double inner = std::cos(spot.inner_angle);
        const double outer = std::cos(spot.outer_angle);
        const double profile = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
        const double ratio = distance / spot.radius;
        const double window = std::pow(std::max(1 - std::pow(ratio, 4), 0.0), 2);
        double depth = 0;
        for (int k = 0; k < kLampSteps; ++k) {
            depth +=
                extinction(position + (k + 0.5) / kLampSteps * from_lamp) * distance / kLampSteps;
        }
        const double mu = -glm::dot(from_lamp / distance, direction);
        const double g = fog.forward;
        const double phase =
            (1 - g * g) / (4 * 3.14159265358979 * std::pow(1 + g * g - 2 * g * mu, 1.5));
        sum += passed * step * extinction(at) * phase * std::exp(-depth) * profile * window
               * spot.intensity / (distance * distance);
        passed *= std::exp(-step * extinction(at));
    }
    return sum;
}

}  // namespace

// Published numbers: 2,000-point Gauss-Legendre quadrature (air-facts, air.fog.airlight).
TEST_CASE_FIXTURE(
    LampScene, "airlight: a point light in even fog by its table" * technique("light.airlight")) {
    struct Row {
        float beside;
        float along;
        std::optional<float> surface;
        float isotropic;
        float forward;
    };
    constexpr Row kRows[] = {
        {1, 5, std::nullopt, 0.805391f, 1.058057f}, {1, 5, 5.0f, 0.415158f, 0.968007f},
        {1, 5, 10.0f, 0.785613f, 1.054945f},        {0.5f, 5, std::nullopt, 1.757268f, 2.679994f},
        {2, 5, std::nullopt, 0.341656f, 0.329737f}, {1, 0, std::nullopt, 0.501069f, 0.115626f},
    };
    for (const Row& row : kRows) {
        CAPTURE(row.beside);
        CAPTURE(row.along);
        const Entity lamp =
            shine(PointLight{.intensity = 100, .radius = 1e4f}, at({row.beside, 0, -row.along}));
        const Entity wall =
            row.surface ? place(
                add(make_square()),
                add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}}),
                affine_from({0, 0, -*row.surface}, {1, 0, 0, 0}, Vec3(20)))
                        : Entity{};
        world.insert_resource(lamp_fog(0));
        CHECK(seen() == test::near(row.isotropic).epsilon(4e-3));
        world.insert_resource(lamp_fog(0.6f));
        CHECK(seen() == test::near(row.forward).epsilon(4e-3));
        world.destroy(lamp);
        if (row.surface) {
            world.destroy(wall);
        }
    }
}

TEST_CASE_FIXTURE(
    LampScene, "airlight: beams of spots in fog that thins with height, by a ray march"
                   * technique("light.airlight")) {
    const SpotLight spot = {
        .intensity = 500,
        .radius = 30,
        .inner_angle = 0.1f,
        .outer_angle = 0.25f,
        .profile = SpotProfile::LinearCosine};
    struct Case {
        Vec3 position;
        Vec3 axis;
        Vec3 direction;
    };
    const Case cases[] = {
        {{-8, 0, -8}, {1, 0, 0}, {0, 0, -1}},         // across
        {{-8, 3, -8}, {1, -0.3f, 0.2f}, {0, 0, -1}},  // across, downward
        {{0.3f, 0, -15}, {0, 0, 1}, {0, 0, -1}},      // into the eye
        {{0, 0.2f, 1}, {0, 0, -1}, {0, 0.02f, -1}},   // away from it
        {{5, 4, -10}, {-1, 0.2f, 0}, {0, 0.45f, -1}},
    };
    for (const Case& one : cases) {
        CAPTURE(one.position);
        const Vec3 axis = glm::normalize(one.axis);
        const Vec3 direction = glm::normalize(one.direction);
        const Entity lamp = shine(SpotLight{spot}, look_at(one.position, one.position + axis));
        const HeightFog fog = lamp_fog(0.4f, 5);
        world.insert_resource(HeightFog{fog});
        const double truth = march(spot, one.position, axis, direction, fog);
        CHECK(truth > 1e-3);
        CHECK(seen(direction) == test::near(truth).epsilon(0.015));
        world.destroy(lamp);
    }
}

TEST_CASE_FIXTURE(
    LampScene, "airlight: no beam beside its cone, behind a wall, or without lamps in the fog") {
    const Entity lamp = shine(
        SpotLight{.intensity = 500, .radius = 30, .inner_angle = 0.1f, .outer_angle = 0.25f},
        look_at({-8, 0, -8}, {8, 0, -8}));
    world.insert_resource(lamp_fog(0.4f));
    CHECK(seen() > 0.01f);
    CHECK(seen({0, 0, 1}) == 0);
    CHECK(seen({0, 1, -1}) == 0);
    CHECK(seen({-1.3f, 0, -1}) == 0);  // past the lamp's back
    HeightFog without = lamp_fog(0.4f);
    without.lamps = 0;
    world.insert_resource(HeightFog{without});
    CHECK(seen() == 0);
    world.insert_resource(lamp_fog(0.4f));
    place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}}),
        affine_from({0, 0, -4}, {1, 0, 0, 0}, Vec3(20)));
    CHECK(seen() == 0);
    world.destroy(lamp);
}

}  // namespace limn::test::airlight_test
