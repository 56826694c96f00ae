#include "ecs/components/ink.h"
#include "ecs/components/shadow.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

// The shading model Toon: bands of flat color, and flat highlights.

namespace limn::test::toon_test {
namespace {

constexpr double kBlend = 4.0 / 256;

/// Color of the light `u`, by its definition: equal bands, linear blends about their edges.
double ramp_value(const std::vector<float>& ramp, double u) {
    const auto count = static_cast<double>(ramp.size());
    double value = ramp[0];
    for (std::size_t i = 1; i < ramp.size(); ++i) {
        const double edge = static_cast<double>(i) / count;
        const double t = std::clamp((u - edge) / kBlend + 0.5, 0.0, 1.0);
        value += t * (static_cast<double>(ramp[i]) - static_cast<double>(ramp[i - 1]));
    }
    return value;
}

Material toon(const std::vector<float>& ramp) {
    Material material = {
        .shading = ShadingModel::Toon, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}};
    for (const float value : ramp) {
        material.ramp.emplace_back(value);
    }
    return material;
}

/// A ball under parallel light that turns a white surface's radiance to n.l.
struct ToonBall : Scene {
    Vec3 to_light = glm::normalize(Vec3(0.8f, 0.3f, 0.5f));
    MaterialId material = add(Material{});
    RenderView view = look({0, 0, 3}, {0, 0, 0}, 96, 96);

    ToonBall() {
        place(add(make_ball(96)), material, at({0, 0, 0}));
        shine(DirectionalLight{.illuminance = kPi}, look_at(to_light, {0, 0, 0}));
    }
    void use(const Material& m) {
        auto& assets = world.resource<Assets>();
        assets.materials[material.index] = m;
        ++assets.material_version;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    ToonBall,
    "toon: light looks up bands of flat color with narrow blends" * technique("tex.toon-ramp")) {
    for (const std::vector<float>& ramp : std::vector<std::vector<float>>{
             {0.1f, 0.5f, 0.9f}, {0.3f, 1.0f}, {0.7f}, {0.2f, 0.2f, 0.2f, 0.6f, 0.6f, 1.0f}}) {
        use(toon(ramp));
        const gpu::FloatImage image = radiance(view);
        const gpu::FloatImage normals = aov(view, "normal");
        int shown = 0;
        int blended = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const Vec3 n = rgb_at(normals, x, y);
                if (glm::length(n) < 0.5f) {
                    continue;
                }
                const double u = std::max(0.0, static_cast<double>(glm::dot(n, to_light)));
                const double expected = ramp_value(ramp, u);
                const bool flat =
                    std::find(ramp.begin(), ramp.end(), static_cast<float>(expected)) != ramp.end();
                ++shown;
                blended += flat ? 0 : 1;
                // Normals have 16 bits, radiance 11.
                const double error = std::abs(static_cast<double>(image.at(x, y, 0)) - expected);
                CHECK(error <= (flat ? 1e-3 : 2e-2));
            }
        }
        CHECK(shown > 800);
        CHECK(blended < shown / 12);
    }
}

TEST_CASE_FIXTURE(
    ToonBall,
    "toon: a surface turned away from the light has the first color" * technique("tex.toon-ramp")) {
    use(toon({0.1f, 0.5f, 0.9f}));
    world.query<const DirectionalLight, WorldTransform>().each(
        [](const DirectionalLight&, WorldTransform& transform) {
            transform.world = look_at({0, 0, -1}, {0, 0, 0});
        });
    const gpu::FloatImage image = radiance(view);
    std::set<float> values;
    for (int y = 40; y < 56; ++y) {
        for (int x = 40; x < 56; ++x) {
            values.insert(image.at(x, y, 1));
        }
    }
    REQUIRE(values.size() == 1);
    CHECK(*values.begin() == near(0.1f).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    ToonBall, "toon: a ramp without colors has three, which change at 0.3 and 0.7"
                  * technique("tex.toon-ramp")) {
    const std::vector<float> tones = {0.25f, 0.25f, 0.25f, 0.6f, 0.6f, 0.6f, 0.6f, 1, 1, 1};
    use(toon({}));
    const gpu::FloatImage unset = radiance(view);
    use(toon(tones));
    CHECK(largest_difference(unset, radiance(view)) == 0);
    CHECK(ramp_value(tones, 0.29) == near(0.25));
    CHECK(ramp_value(tones, 0.5) == near(0.6).epsilon(1e-6));
    CHECK(ramp_value(tones, 0.71) == near(1));
}

TEST_CASE_FIXTURE(
    RenderTest,
    "toon: a blend is four of 256 texels wide, and no steeper" * technique("tex.toon-ramp")) {
    std::vector<Vec4> inputs;
    for (int i = 0; i <= 2560; ++i) {
        inputs.emplace_back(static_cast<float>(i) / 2560, 0, 0, 0);
    }
    const std::vector<Vec4> steps =
        evaluate_shader("#include \"lib/toon_ramp.glsl\"\n", "y.x = toon_step(0.5, x.x);", inputs);
    int rising = 0;
    for (std::size_t i = 1; i < steps.size(); ++i) {
        const float step = steps[i].x - steps[i - 1].x;
        CHECK(step >= 0);
        CHECK(step <= 1.0f / 40 + 1e-4f);
        rising += step > 0 ? 1 : 0;
    }
    CHECK(rising <= 41);  // 4/256 of 2560 steps
    CHECK(steps.front().x == 0);
    CHECK(steps.back().x == 1);
}

TEST_CASE_FIXTURE(ToonBall, "toon: highlights are flat" * technique("tex.toon-ramp")) {
    Material shiny = toon({0});
    shiny.specular = {0.5f, 0.5f, 0.5f};
    shiny.shininess = 20;
    use(shiny);
    const gpu::FloatImage image = radiance(view);
    int full = 0;
    int between = 0;
    for (std::size_t i = 0; i < image.pixels.size();
         i += static_cast<std::size_t>(image.channels)) {
        const float value = image.pixels[i];
        full += std::abs(value - 0.5f) < 1e-3f ? 1 : 0;
        between += value > 1e-3f && value < 0.499f ? 1 : 0;
        CHECK(value <= 0.501f);
    }
    CHECK(full > 40);
    CHECK(between < full / 4);
}

TEST_CASE_FIXTURE(Scene, "toon: shadows have the first color, as surfaces turned away do") {
    const MaterialId paper = add(toon({0.2f, 0.8f}));
    const MeshId square = add(make_square());
    place(square, paper, at({0, 0, 0}));
    place(square, paper, affine_from({0, 0, 0.5f}, {1, 0, 0, 0}, Vec3(0.3f)));
    const Entity sun = shine(
        DirectionalLight{.illuminance = kPi},
        affine_from({0, 0, 0}, glm::angleAxis(radians(45.0f), Vec3(0, 1, 0)), Vec3(1)));
    world.add(sun, Shadow{.resolution = 512, .distance = 4});
    const gpu::FloatImage image = radiance(look({0, 0, 2}, {0, 0, 0}, 128, 128));
    // The blocker's shadow is half a meter to the left of it.
    int dark = 0;
    int other = 0;
    for (int y = 60; y < 68; ++y) {
        for (int x = 34; x < 50; ++x) {
            const float value = image.at(x, y, 0);
            dark += std::abs(value - 0.2f) < 1e-3f ? 1 : 0;
            other += std::abs(value - 0.2f) >= 1e-3f && std::abs(value - 0.8f) >= 1e-3f ? 1 : 0;
        }
    }
    CHECK(dark >= 50);
    CHECK(other <= 32);  // the filtered rim
}

}  // namespace limn::test::toon_test
