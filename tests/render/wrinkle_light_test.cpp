#include "ecs/components/rendering.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/render/wrinkle_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::test::wrinkle_light_test {
namespace {

/// Wrinkled skin under one light, in empty space.
struct WrinkleLightScene : WrinkleScene {
    WrinkleLightScene() {
        light = shine(DirectionalLight{.illuminance = 3}, look_at({1, 2, 3}, {0, 0, 0}));
    }
    /// Color of the square shortened by `weight`.
    std::vector<float> pixels(const WrinkleSurface& surface, float weight = 0.2f) {
        const Entity entity = square(surface, weight);
        std::vector<float> result = radiance(view).pixels;
        world.destroy(entity);
        return result;
    }
    Vec3 center_pixel(const WrinkleSurface& surface, float weight = 0.2f) {
        const Entity entity = square(surface, weight);
        const Vec3 result = rgb_at(radiance(view), 16, 16);
        world.destroy(entity);
        return result;
    }
    void turn_light(const Vec3& to_light) {
        world.add(light, WorldTransform{look_at(to_light, {0, 0, 0})});
    }
    Entity light;
};

/// Wrinkles are raised in full, even at rest.
constexpr WrinkleSurface in_full(WrinkleMethod method) {
    return {.method = method, .lambda = 0.1f, .beta = 50};
}

/// NaN if either has one.
float largest_distance(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    float most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float distance = std::abs(a[i] - b[i]);
        most = distance <= most ? most : distance;
    }
    return most;
}

}  // namespace

TEST_CASE_FIXTURE(
    WrinkleLightScene,
    "wrinkle light: blended light is the light of both normals, weighted by the intensity"
        * technique("wrinkle.compression.bump-blend")) {
    material.specular = {0.3f, 0.3f, 0.3f};
    for (const ShadingModel model : {ShadingModel::Pbr, ShadingModel::Blinn, ShadingModel::Skin}) {
        material.shading = model;
        for (const float weight : {0.05f, 0.1f, 0.3f}) {
            const Vec3 wrinkled = center_pixel(in_full(WrinkleMethod::Bump), weight);
            const Vec3 smooth = center_pixel({.method = WrinkleMethod::None}, weight);
            const Vec3 blended =
                center_pixel({.method = WrinkleMethod::Blend, .lambda = 1}, weight);
            const float intensity = wrinkle_intensity(limn::square(1 - weight), 1, 4);
            CHECK(glm::length(wrinkled - smooth) > 0.01f);
            CHECK(
                glm::length(blended - glm::mix(smooth, wrinkled, intensity))
                <= 2e-3f * glm::length(wrinkled - smooth));
        }
    }
}

TEST_CASE_FIXTURE(
    WrinkleLightScene, "wrinkle light: blended light is exact at both ends, by any method"
                           * technique("face.wrinkle-options, wrinkle.compression.bump-blend")) {
    for (const LightMethod method :
         {LightMethod::Clustered, LightMethod::FullScreen, LightMethod::ObjectMajor,
          LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        const std::vector<float> blended_none = pixels({.method = WrinkleMethod::Blend}, 0);
        const std::vector<float> none = pixels({.method = WrinkleMethod::None}, 0);
        CHECK(largest_distance(blended_none, none) <= (device().caps().software ? 0.0f : 1e-6f));
        const std::vector<float> in_full_blended = pixels(in_full(WrinkleMethod::Blend));
        const std::vector<float> bumped = pixels(in_full(WrinkleMethod::Bump));
        CHECK(largest_distance(in_full_blended, bumped) <= 1e-6f);
        CHECK(pixels({.method = WrinkleMethod::Blend}) != pixels({.method = WrinkleMethod::None}));
        CHECK(pixels({.method = WrinkleMethod::Blend}) != pixels({.method = WrinkleMethod::Bump}));
    }
}

TEST_CASE(
    "wrinkle light: the factor that fades grazing light is that of Equation 9"
    * technique("wrinkle.compression.lighting")) {
    const std::vector<Vec4> found = evaluate_shader(
        "#define SMOOTH_NORMALS\n#include \"lib/reflector.glsl\"", "y.x = grazing_fade(x.x);",
        {{-0.1f, 0, 0, 0}, {0, 0, 0, 0}, {0.0625f, 0, 0, 0}, {0.125f, 0, 0, 0}, {0.5f, 0, 0, 0}});
    const float expected[] = {0, 0, 0.5f, 1, 1};
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(found[i].x == expected[i]);
    }
}

TEST_CASE_FIXTURE(
    WrinkleLightScene,
    "wrinkle light: light behind the smooth skin lights no slope of its wrinkles"
        * technique("wrinkle.compression.lighting, wrinkle.compression.tangent-frame")) {
    WrinkleSurface bump = in_full(WrinkleMethod::Bump);
    // The slope faces up and to the viewer: light from above the plane's edge falls on it.
    turn_light(glm::normalize(Vec3{0, 1, -0.05f}));
    const Vec3 to_slope = glm::normalize(Vec3(0, -map_slope().y, 1));
    REQUIRE(glm::dot(to_slope, Vec3{0, 1, -0.05f}) > 0.1f);
    CHECK(center_pixel(bump).x > 0.05f);
    bump.fade = true;
    CHECK(center_pixel(bump) == Vec3(0));
    CHECK(center_pixel({.method = WrinkleMethod::Blend, .fade = true}) == Vec3(0));

    // Halfway to a cosine of 1/8 half of it remains.
    turn_light(Vec3{0, std::sqrt(1 - limn::square(0.0625f)), 0.0625f});
    const float faded = center_pixel(bump).x;
    bump.fade = false;
    CHECK(faded == near(0.5f * center_pixel(bump).x).epsilon(4e-3));
    turn_light(Vec3{0, std::sqrt(1 - limn::square(0.2f)), 0.2f});
    const float full = center_pixel(bump).x;
    bump.fade = true;
    CHECK(center_pixel(bump).x == near(full).epsilon(1e-4));
}

TEST_CASE_FIXTURE(
    WrinkleLightScene, "wrinkle light: with a shininess of 4 it is the Blinn model of the wrinkles"
                           * technique("wrinkle.compression.lighting")) {
    material.shading = ShadingModel::Blinn;
    material.shininess = 4;
    material.specular = {1, 1, 1};
    material.base_color = {1, 1, 1, 1};
    world.get<DirectionalLight>(light).illuminance = kPi;
    turn_light({0, 0, 1});
    const WrinkleSurface none = {.method = WrinkleMethod::None};
    CHECK(center_pixel(none).x == near(2).epsilon(2e-3));  // N = L = H
    const Vec3 to_eye = glm::normalize(Vec3{-1, 1, 32});   // from the center_pixel of the pixel
    const Vec3 half = glm::normalize(to_eye + Vec3{0, 0, 1});
    const Vec3 n = glm::normalize(Vec3(0, -map_slope().y, 1));
    const float highlight = std::pow(glm::dot(n, half), 4.0f);
    WrinkleSurface bump = in_full(WrinkleMethod::Bump);
    bump.fade = true;
    CHECK(center_pixel(bump).x == near(n.z + highlight).epsilon(5e-3));
    material.base_color = {0, 0, 0, 1};
    CHECK(center_pixel(bump).x == near(highlight).epsilon(5e-3));
}

TEST_CASE_FIXTURE(
    WrinkleLightScene, "wrinkle light: skin without interpolation has one strength per triangle"
                           * technique("wrinkle.compression.interpolation")) {
    // Wide at the top: its triangles are compressed differently.
    const auto strengths = [&](bool interpolate) {
        MeshData mesh = make_square();
        MorphTarget& flat = mesh.morphs.emplace_back();
        flat.name = "flat";
        flat.vertices = {0, 2};
        flat.positions = {
            mesh.positions[0] * Vec3{0, -1, 0}, mesh.positions[2] * Vec3{0, -0.2f, 0}};
        const Entity entity = skin(
            std::move(mesh), {.method = WrinkleMethod::Bump, .interpolate = interpolate}, 0.5f);
        const gpu::FloatImage normal = aov(view, "normal");
        world.destroy(entity);
        std::vector<float> found;
        for (int y = 10; y < 22; ++y) {
            const Vec3 n = rgb_at(normal, 16 - (y - 16) / 2 + 4, y);  // right of the diagonal
            found.push_back(n.y / n.z);
        }
        return found;
    };
    const std::vector<float> flat = strengths(false);
    CHECK(std::ranges::max(flat) - std::ranges::min(flat) < 1e-3f);
    const std::vector<float> smooth = strengths(true);
    CHECK(std::ranges::max(smooth) - std::ranges::min(smooth) > 0.02f);
}

}  // namespace limn::test::wrinkle_light_test
