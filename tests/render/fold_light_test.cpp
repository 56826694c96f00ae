#include "bench/oracles/groove_oracle.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/render/wrinkle_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace limn::test::fold_light_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
const char* const kInclude = "#include \"lib/fold_light.glsl\"";

/// A light in the cross-section of a groove whose walls have some slope.
struct GrooveLight {
    double slope;
    double x;
    double y;
};

std::vector<GrooveLight> groove_lights() {
    std::vector<GrooveLight> lights;
    for (const double slope : {5.0, 20.0, 35.0, 50.0, 60.0}) {
        for (const double angle : {-80.0, -55.0, -30.0, -5.0, 15.0, 40.0, 70.0}) {
            for (const double across : {1.0, 0.6}) {
                lights.push_back(
                    {slope * kDegree, across * std::sin(angle * kDegree),
                     across * std::cos(angle * kDegree)});
            }
        }
    }
    return lights;
}

/// open, n_l and m_l of the left wall.
Vec4 shader_input(const GrooveLight& light, double albedo) {
    const double c = std::cos(light.slope);
    const double n_l = light.x * std::sin(light.slope) + light.y * c;
    return {
        static_cast<float>(c), static_cast<float>(std::max(n_l, 0.0)), static_cast<float>(light.y),
        static_cast<float>(albedo)};
}

/// Skin folded with a single slope, under one light.
struct FoldLightScene : WrinkleScene {
    FoldLightScene() {
        material.roughness = 1;
        material.specular = {0, 0, 0};
        light = shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 3}, {0, 0, 0}));
    }
    Vec3 center_pixel(const WrinkleSurface& surface, float weight = 0.3f) {
        const Entity entity = square(surface, weight);
        const Vec3 result = rgb_at(radiance(view), 16, 16);
        world.destroy(entity);
        return result;
    }
    /// Skin at rest whose normal a G-buffer cannot store exactly.
    Vec3 tilted(const WrinkleSurface& surface) {
        MeshData mesh = make_square();
        mesh.normals.assign(4, glm::normalize(Vec3{0.31f, -0.17f, 1}));
        mesh.morphs.emplace_back().name = "none";
        const Entity entity = skin(std::move(mesh), surface, 0);
        const Vec3 result = rgb_at(radiance(view), 16, 16);
        world.destroy(entity);
        return result;
    }
    void turn_light(const Vec3& to_light) {
        world.add(light, WorldTransform{look_at(to_light, {0, 0, 0})});
    }
    Entity light;
};

const WrinkleSurface kFolds = {.share = 1};
const WrinkleSurface kSingleSlopes = {.bounce = false, .share = 1};

}  // namespace

TEST_CASE(
    "fold light: the light on each wall of a groove, even in shadow, is the oracle's"
    * technique("wrinkle.fold-light")) {
    std::vector<Vec4> inputs;
    for (const GrooveLight& light : groove_lights()) {
        inputs.push_back(shader_input(light, 0));
    }
    const std::vector<Vec4> found =
        evaluate_shader(kInclude, "y.xy = wall_cosines(x.x, x.y, x.z);", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const GrooveLight light = groove_lights()[i];
        const oracle::GrooveWalls walls = oracle::groove_cosines(light.slope, light.x, light.y);
        CAPTURE(light.slope / kDegree);
        CAPTURE(light.x);
        CHECK(std::abs(static_cast<double>(found[i].x) - walls.left) <= 4e-3);
        CHECK(std::abs(static_cast<double>(found[i].y) - walls.right) <= 4e-3);
    }
}

TEST_CASE(
    "fold light: with all bounces a wall of skin matches radiosity, to 3 % of the light"
    * technique("wrinkle.fold-light")) {
    for (const double albedo : {0.1, 0.3, 0.6}) {
        std::vector<Vec4> inputs;
        for (const GrooveLight& light : groove_lights()) {
            inputs.push_back(shader_input(light, albedo));
        }
        const std::vector<Vec4> found = evaluate_shader(
            kInclude,
            "vec2 walls = wall_cosines(x.x, x.y, x.z);"
            "y.rgb = x.w * wall_light(x.x, vec3(x.w), vec3(walls.x), walls.y);",
            inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const GrooveLight light = groove_lights()[i];
            const double expected =
                oracle::groove_radiosity(light.slope, albedo, light.x, light.y).left;
            CAPTURE(albedo);
            CAPTURE(light.slope / kDegree);
            CAPTURE(light.x);
            CHECK(std::abs(static_cast<double>(found[i].x) - expected) <= 0.03);
        }
    }
}

TEST_CASE(
    "fold light: in ambient light a groove is as bright as by radiosity, to 2.5 %"
    * technique("wrinkle.fold-light")) {
    std::vector<Vec4> inputs;
    for (const float slope : {0.0f, 10.0f, 25.0f, 40.0f, 50.0f, 60.0f}) {
        for (const float albedo : {0.0f, 0.3f, 0.6f, 0.9f, 1.0f}) {
            inputs.emplace_back(slope * static_cast<float>(kDegree), albedo, 0, 0);
        }
    }
    const std::vector<Vec4> found =
        evaluate_shader(kInclude, "y.rgb = x.y * wall_light_around(cos(x.x), vec3(x.y));", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double albedo = inputs[i].y;
        const double expected =
            oracle::groove_radiosity_around(static_cast<double>(inputs[i].x), albedo);
        CAPTURE(inputs[i].x);
        CAPTURE(albedo);
        CHECK(found[i].x == near(expected).epsilon(0.025));
    }
}

TEST_CASE(
    "fold light: a white groove is as bright as white skin, whatever the light and slope"
    * technique("wrinkle.fold-light")) {
    std::vector<Vec4> inputs;
    for (const GrooveLight& light : groove_lights()) {
        inputs.push_back(shader_input(light, 1));
    }
    const std::vector<Vec4> found = evaluate_shader(
        kInclude,
        "vec2 walls = wall_cosines(x.x, x.y, x.z);"
        "y.x = wall_light(x.x, vec3(1.0), vec3(walls.x), walls.y).x;"
        "y.y = wall_light(x.x, vec3(1.0), vec3(walls.y), walls.x).x;",
        inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        CHECK(0.5f * (found[i].x + found[i].y) == near(inputs[i].z).epsilon(1e-4));
    }
}

TEST_CASE_FIXTURE(
    FoldLightScene, "fold light: the wall that faces away is lit by the other one, and redder"
                        * technique("wrinkle.fold-light")) {
    const Vec3 flat = center_pixel({.method = WrinkleMethod::None});
    // Along the plane, nearly: the slope faces down, away from it.
    turn_light(Vec3{0, 0.8f, 0.6f});
    const Entity entity = square(kFolds, 0.3f);
    const Vec3 n = glm::normalize(rgb_at(aov(view, "normal"), 16, 16));
    world.destroy(entity);
    turn_light(glm::normalize(Vec3{0, n.y > 0 ? -0.9f : 0.9f, 0.35f}));
    CHECK(center_pixel(kSingleSlopes) == Vec3(0));
    const Vec3 lit = center_pixel(kFolds);
    CHECK(lit.x > 0.02f * flat.x);
    CHECK(lit.x / lit.z > 1.5f * flat.x / flat.z);

    const float n_z = n.z;
    const double slope = std::acos(static_cast<double>(n_z));
    const Vec3 to_light = glm::normalize(Vec3{0, n.y > 0 ? -0.9f : 0.9f, 0.35f});
    for (int c = 0; c < 3; ++c) {
        const double albedo = material.base_color[c];
        const double expected =
            oracle::groove_radiosity(slope, albedo, -std::abs(to_light.y), to_light.z).left;
        CHECK(std::abs(static_cast<double>(lit[c]) - expected) <= 0.015);
    }
}

TEST_CASE_FIXTURE(
    FoldLightScene, "fold light: skin without folds is bit-identical to skin without the effect"
                        * technique("wrinkle.fold-light")) {
    CHECK(center_pixel(kFolds, 0) == center_pixel(kSingleSlopes, 0));
    CHECK(center_pixel(kFolds, 0) == center_pixel({.method = WrinkleMethod::None}, 0));
    turn_light(glm::normalize(Vec3{0.8f, -0.3f, 0.2f}));
    CHECK(tilted(kFolds) == tilted({.method = WrinkleMethod::None}));
    CHECK(center_pixel(kFolds) != center_pixel(kSingleSlopes));
    const WrinkleSurface bump = {.method = WrinkleMethod::Bump, .lambda = 0.1f, .beta = 50};
    WrinkleSurface without = bump;
    without.bounce = false;
    CHECK(center_pixel(bump) == center_pixel(without));
}

TEST_CASE_FIXTURE(
    FoldLightScene, "fold light: every method of summing lights draws the same folds"
                        * technique("wrinkle.fold-light")) {
    turn_light(glm::normalize(Vec3{0, -0.7f, 0.5f}));
    const Vec3 clustered = center_pixel(kFolds);
    CHECK(clustered.x > 0.01f);
    for (const LightMethod method :
         {LightMethod::FullScreen, LightMethod::ObjectMajor, LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        const Vec3 found = center_pixel(kFolds);
        for (int c = 0; c < 3; ++c) {
            CHECK(found[c] == near(clustered[c]).epsilon(5e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    FoldLightScene, "fold light: no light shines through the wall of a fold, which has no back"
                        * technique("wrinkle.fold-light")) {
    // In its shadow map, the skin never blocks light from itself, as if it were thin.
    world.add(light, Shadow{});
    material.shading = ShadingModel::Subsurface;
    material.gloss = 0;
    turn_light(glm::normalize(Vec3{0, -0.9f, 0.35f}));  // the slope faces up, away from it
    const Vec3 opaque = center_pixel(kFolds);
    CHECK(opaque.x > 0.01f);
    material.scatter = Vec3(0.02f);
    const Vec3 translucent = center_pixel(kFolds);
    for (int c = 0; c < 3; ++c) {
        CHECK(translucent[c] == near(opaque[c]).epsilon(0.02));
    }
    CHECK(center_pixel(kSingleSlopes).x > 1.5f * translucent.x);
}

TEST_CASE_FIXTURE(
    FoldLightScene,
    "fold light: skin that emits light keeps it" * technique("wrinkle.fold-light")) {
    material.emission = {0.2f, 0.3f, 0.4f};
    turn_light({0, 0, -1});
    const Vec3 folded = center_pixel(kFolds);
    for (int c = 0; c < 3; ++c) {
        CHECK(folded[c] == near(material.emission[c]).epsilon(5e-3));
    }
}

}  // namespace limn::test::fold_light_test
