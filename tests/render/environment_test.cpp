// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
// clang-format on
#include "bench/oracles/pbr_oracle.h"
#include "render/environment/environment_light.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <random>

namespace limn::test::environment_test {
namespace {

const Environment kSkies[] = {
    {.sky = SkyKind::Gradient},
    {.sky = SkyKind::Studio, .intensity = 0.7f},
    {.sky = SkyKind::Uniform, .zenith = {0.3f, 0.5f, 0.9f}, .intensity = 2}};

layout::EnvironmentBlock block_of(const Environment& environment) {
    return make_environment_block(environment, {0, 1, 0}, Vec3(0));
}

/// Irradiance / pi by summing the sky over the hemisphere.
Vec3 gathered(const layout::EnvironmentBlock& block, const Vec3& normal) {
    const Vec3 t = any_perpendicular(normal);
    const Vec3 b = glm::cross(normal, t);
    glm::dvec3 sum(0);
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
        // Equal steps of sin^2: every sample weighs the same under the cosine.
        const float sine = std::sqrt((static_cast<float>(i) + 0.5f) / kSteps);
        for (int j = 0; j < kSteps; ++j) {
            const float phi = 2 * kPi * (static_cast<float>(j) + 0.5f) / kSteps;
            sum += sky_radiance(
                block, sine * (std::cos(phi) * t + std::sin(phi) * b)
                           + std::sqrt(1 - sine * sine) * normal);
        }
    }
    return Vec3(sum / double(kSteps * kSteps));
}

struct BallScene : Scene {
    /// A ball lit by this environment only, with its center facing the camera.
    gpu::FloatImage ball(const Material& material, const Environment& environment) {
        world.clear();
        world.insert_resource(environment);
        place(add(make_ball(64)), add(material), at({0, 0, 0}));
        return radiance(look({0, 0, 2}, {0, 0, 0}, 64, 64));
    }
};

}  // namespace

TEST_CASE(
    "environment: nine harmonics reproduce a uniform sky exactly, others within a fifth"
    * technique("env.image-based-light")) {
    std::mt19937 random(2);
    std::normal_distribution<float> normal;
    for (const Environment& environment : kSkies) {
        const layout::EnvironmentBlock block = block_of(environment);
        const layout::Irradiance projected = project_irradiance(block);
        const float slack = environment.sky == SkyKind::Uniform ? 1e-3f : 0.2f;
        for (int i = 0; i < 20; ++i) {
            const Vec3 n = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
            const Vec3 want = gathered(block, n);
            const Vec3 got = irradiance_toward(projected, n);
            for (int c = 0; c < 3; ++c) {
                CHECK(std::abs(got[c] - want[c]) <= slack * std::max(want[c], 0.3f));
            }
        }
    }
}

TEST_CASE(
    "environment: the table of specular albedo matches the oracle"
    * technique("env.image-based-light, light.microfacet")) {
    constexpr int kSize = 32;
    const std::vector<Vec2> table = make_specular_albedo(kSize);
    for (int y = 3; y < kSize; y += 4) {
        for (int x = 1; x < kSize; x += 5) {
            const auto want =
                oracle::directional_albedo(x / double(kSize - 1), y / double(kSize - 1), 1 << 16);
            const Vec2 got = table[y * kSize + x];
            CHECK(std::abs(got.x - want.scale) < 0.01);
            CHECK(got.x + got.y == test::near(want.scale + want.bias).epsilon(0.01));
        }
    }
}

TEST_CASE("environment: the metal-rough model returns all light of a white furnace, summed light "
          "by light") {
    for (const double roughness : {0.1, 0.5, 1.0}) {
        for (const double n_v : {0.3, 0.6, 0.95}) {
            const double metal = oracle::furnace({glm::dvec3(1), 1, roughness}, n_v, 1024).x;
            const double plastic = oracle::furnace({glm::dvec3(1), 0, roughness}, n_v).x;
            CAPTURE(roughness);
            CAPTURE(n_v);
            CHECK(metal == test::near(1).epsilon(0.02));
            CHECK(plastic == test::near(1).epsilon(0.02));
        }
    }
}

TEST_CASE_FIXTURE(
    BallScene, "environment: a white ball vanishes in a white furnace, at any roughness"
                   * technique("light.microfacet")) {
    for (const float metalness : {0.0f, 1.0f}) {
        for (const float roughness : {0.1f, 0.5f, 1.0f}) {
            const Material white = {
                .base_color = {1, 1, 1, 1}, .metalness = metalness, .roughness = roughness};
            const gpu::FloatImage image =
                ball(white, {.sky = SkyKind::Uniform, .zenith = {1, 1, 1}, .visible = true});
            float low = INFINITY;
            float high = 0;
            for (int y = 0; y < 64; ++y) {
                for (int x = 0; x < 64; ++x) {
                    low = std::min(low, image.at(x, y, 0));
                    high = std::max(high, image.at(x, y, 0));
                }
            }
            CAPTURE(metalness);
            CAPTURE(roughness);
            CHECK(low > 0.98f);
            CHECK(high < 1.02f);
        }
    }
}

TEST_CASE_FIXTURE(Scene, "environment: the background is the sky function, along every ray") {
    for (const Environment& environment : kSkies) {
        world.insert_resource(environment);
        const layout::EnvironmentBlock block = block_of(environment);
        const Vec3 eye = {1, 2, 3};
        const RenderView view = look(eye, eye + Vec3(0.3f, 0.1f, 1), 48, 32);
        const gpu::FloatImage image = radiance(view);
        const Mat4 world_from_clip = glm::inverse(view.clip_from_world);
        for (int y = 0; y < 32; y += 3) {
            for (int x = 0; x < 48; x += 3) {
                const Vec2 ndc = {
                    (static_cast<float>(x) + 0.5f) / 24 - 1,
                    1 - (static_cast<float>(y) + 0.5f) / 16};
                const Vec4 near = world_from_clip * Vec4(ndc, 1, 1);
                const Vec3 direction = glm::normalize(Vec3(near) / near.w - eye);
                if (environment.sky != SkyKind::Studio) {  // whose lamps are invisible
                    CHECK(
                        glm::distance(rgb_at(image, x, y), sky_radiance(block, direction)) < 2e-3f);
                }
                CHECK(image.at(x, y, 3) == 1);
            }
        }
    }
    world.insert_resource(Environment{.visible = false});
    const gpu::FloatImage hidden = radiance(look({0, 0, 1}, {0, 0, 0}, 8, 8));
    CHECK(largest_difference(hidden, gpu::FloatImage{8, 8, 4, std::vector<float>(8 * 8 * 4)}) == 0);
}

TEST_CASE_FIXTURE(
    BallScene, "environment: a mirror shows the sky where it is, without a seam"
                   * technique("env.image-based-light")) {
    const Material mirror = {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0};
    for (const Environment& environment : kSkies) {
        const layout::EnvironmentBlock block = block_of(environment);
        const gpu::FloatImage image = ball(mirror, environment);
        int close = 0;
        int all = 0;
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const Vec3 ray = glm::normalize(Vec3(
                    (static_cast<float>(x) + 0.5f) / 32 - 1,
                    1 - (static_cast<float>(y) + 0.5f) / 32, -1));
                // Of the unit ball viewed from (0, 0, 2).
                const float b = glm::dot(Vec3(0, 0, 2), ray);
                const float under_root = b * b - 3;
                if (under_root < 0.15f) {
                    continue;  // beside the ball, or its rim
                }
                const Vec3 n = Vec3(0, 0, 2) + (-b - std::sqrt(under_root)) * ray;
                const Vec3 want = sky_radiance(block, glm::reflect(ray, n));
                close +=
                    glm::distance(rgb_at(image, x, y), want) < 0.05f * (0.2f + glm::length(want));
                ++all;
            }
        }
        CHECK(all > 500);
        CHECK(close > 0.93 * all);  // the rest lies on edges of lamps and on the horizon
    }
}

TEST_CASE_FIXTURE(
    BallScene, "environment: from below, where the octahedron folds, there is no visible seam") {
    for (const float roughness : {0.05f, 0.3f, 0.6f}) {
        world.clear();
        world.insert_resource(
            Environment{.zenith = {4, 4, 4}, .horizon = {1, 1, 1}, .ground = {0.1f, 0.1f, 0.1f}});
        const Material mirror = {
            .base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = roughness};
        place(add(make_ball(64)), add(mirror), at({0, 0, 0}));
        const gpu::FloatImage image = radiance(look({0, -3, 0}, {0, 0, 0}, 96, 96));
        // Its center reflects the ground straight below, where the corners of the map meet.
        float low = INFINITY;
        float high = 0;
        for (int y = 46; y < 50; ++y) {
            for (int x = 46; x < 50; ++x) {
                low = std::min(low, image.at(x, y, 0));
                high = std::max(high, image.at(x, y, 0));
            }
        }
        CAPTURE(roughness);
        CHECK(low > 0.09f);
        CHECK(high < low * 1.1f);
    }
}

TEST_CASE_FIXTURE(
    BallScene, "environment: rougher mirrors blur the sky and preserve its mean"
                   * technique("env.image-based-light")) {
    const auto mean_and_spread = [&](float roughness) {
        const gpu::FloatImage image = ball(
            {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = roughness},
            {.sky = SkyKind::Studio});
        double sum = 0;
        double squares = 0;
        int count = 0;
        for (int y = 20; y < 44; ++y) {
            for (int x = 20; x < 44; ++x) {
                sum += image.at(x, y, 1);
                squares += square(image.at(x, y, 1));
                ++count;
            }
        }
        return Vec2(sum / count, squares / count - square(sum / count));
    };
    float last = INFINITY;
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
        const Vec2 measured = mean_and_spread(roughness);
        CHECK(measured.y < last);
        last = measured.y;
    }
}

TEST_CASE_FIXTURE(BallScene, "environment: the ground lights from below, the sky from above") {
    const gpu::FloatImage image = ball(
        {.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}},
        {.zenith = {0, 0, 1}, .horizon = {0, 0, 1}, .ground = {1, 0, 0}});
    CHECK(image.at(32, 16, 2) > 2 * image.at(32, 16, 0));
    CHECK(image.at(32, 48, 0) > image.at(32, 48, 2));
}

TEST_CASE_FIXTURE(
    Scene, "environment: the sun's disc is in the direction of the first directional light") {
    world.insert_resource(Environment{});
    const Vec3 sun = glm::normalize(Vec3(0.2f, 0.3f, -1));
    shine(DirectionalLight{.illuminance = 3}, look_at(sun, {0, 0, 0}));
    const RenderView view = look({0, 0, 0}, {0, 0, -1}, 401, 401);
    const gpu::FloatImage image = radiance(view);
    Vec2 brightest = {0, 0};
    float peak = 0;
    for (int y = 0; y < 401; ++y) {
        for (int x = 0; x < 401; ++x) {
            if (image.at(x, y, 1) > peak) {
                peak = image.at(x, y, 1);
                brightest = {x, y};
            }
        }
    }
    const Vec2 want = {(0.2f + 1) * 200.5f - 0.5f, (1 - 0.3f) * 200.5f - 0.5f};
    CHECK(peak > 100);
    CHECK(glm::distance(brightest, want) < 2.5f);
}

}  // namespace limn::test::environment_test
