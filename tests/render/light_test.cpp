#include "bench/oracles/light_oracle.h"
#include "bench/oracles/pbr_oracle.h"
#include "ecs/components/time.h"
#include "render/gpu/shader_source.h"
#include "render/light/light_list.h"
#include "render/material/shading_models.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <array>
#include <numbers>

namespace limn::test::light_test {
namespace {

using oracle::DVec3;
constexpr double kPiD = std::numbers::pi;

double deg(double degrees) {
    return degrees * kPiD / 180;
}

Attenuation polynomial(float c, float l, float q) {
    return {.falloff = Falloff::Polynomial, .constant = c, .linear = l, .quadratic = q};
}
Attenuation smooth(float multiplier) {
    return {.falloff = Falloff::Smooth, .multiplier = multiplier};
}

/// Blinn or Phong without a mirror: what a matte surface is.
Material matte(const Vec3& color) {
    return {.shading = ShadingModel::Blinn, .base_color = Vec4(color, 1), .specular = {0, 0, 0}};
}

oracle::ClassicMaterial as_oracle(const Material& m) {
    return {
        .ambient = DVec3(0),
        .diffuse = DVec3(m.base_color),
        .specular = DVec3(m.specular),
        .shininess = m.shininess};
}

/// A plane of side 2 in z = 0, viewed from (0, 0, 1): pixel (x, y) of an n x n image shows this
/// point.
Vec3 plane_point(int x, int y, int n) {
    const auto to_plane = [n](int i) {
        return (2.0f * (static_cast<float>(i) + 0.5f) / static_cast<float>(n)) - 1.0f;
    };
    return {to_plane(x), -to_plane(y), 0};
}

constexpr int kSide = 32;

/// Largest difference of image and oracle, relative to the brightest of the oracle's values.
template <typename Reference>
double deviation(const gpu::FloatImage& image, Reference&& reference) {
    double worst = 0;
    double brightest = 1e-9;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const DVec3 want = reference(plane_point(x, y, image.width));
            const DVec3 got = rgb_at(image, x, y);
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(got[c] - want[c]));
                brightest = std::max(brightest, want[c]);
            }
        }
    }
    return worst / brightest;
}

struct PlaneScene : Scene {
    explicit PlaneScene(const Material& material = matte({1, 1, 1})) {
        place(add(make_square()), add(material), at({0, 0, 0}));
    }
    [[nodiscard]] RenderView view() const { return look({0, 0, 1}, {0, 0, 0}, kSide, kSide); }
    gpu::FloatImage picture() { return radiance(view()); }
};

const DVec3 kEye = {0, 0, 1};
const DVec3 kUp = {0, 0, 1};  // the plane's normal

}  // namespace

// ---- formulas
// ------------------------------------------------------------------------------------

TEST_CASE(
    "light: attenuation by a polynomial has the values of light.attenuation"
    * technique("light.attenuation")) {
    const auto value = [](float c, float l, float q, double d) {
        return oracle::attenuation(polynomial(c, l, q), 0, d);
    };
    CHECK(value(1, 0, 0, 123) == test::near(1));
    CHECK(value(0, 1, 0, 2) == test::near(0.5));
    CHECK(value(0, 1, 0, 10) == test::near(0.1));
    CHECK(value(0, 0, 1, 2) == test::near(0.25));
    CHECK(value(0, 0, 1, 10) == test::near(0.01));
    CHECK(value(1, 0.7f, 1.8f, 0) == test::near(1));
    CHECK(value(1, 0.7f, 1.8f, 1) == test::near(0.285714).epsilon(1e-5));
    CHECK(value(1, 0.7f, 1.8f, 2) == test::near(0.104167).epsilon(1e-5));
    CHECK(value(1, 0.7f, 1.8f, 5) == test::near(0.020202).epsilon(1e-5));
    CHECK(value(1, 0.7f, 1.8f, 10) == test::near(0.005319).epsilon(1e-4));
    CHECK(oracle::cutoff_distance(polynomial(1, 0.7f, 1.8f), 1.0 / 256) == test::near(11.7095));
    CHECK(std::isfinite(value(0, 1, 1, 0)));
}

TEST_CASE(
    "light: the smooth falloff has the values of engine.light-falloff"
    * technique("char.skin-shade, engine.light-falloff")) {
    const auto value = [](float m, double fraction) {
        return oracle::attenuation(smooth(m), 8, 8 * fraction);
    };
    CHECK(value(1, 0) == test::near(1));
    CHECK(value(1, 0.5) == test::near(0.75));
    CHECK(value(1, 0.75) == test::near(0.4375));
    CHECK(value(1, 1) == test::near(0).scale(1));
    CHECK(value(2, 0.7071) == test::near(1).epsilon(1e-4));
    CHECK(value(2, 0.75) == test::near(0.875));
    CHECK(value(2, 0.9) == test::near(0.38));
    CHECK(value(4, 0.866) == test::near(1).epsilon(1e-3));
    for (const float m : {1.0f, 2.0f, 4.0f, 9.0f}) {
        CHECK(value(m, 0.999 * std::sqrt(1 - 1 / m)) == 1);
        CHECK(value(m, 1.001) == 0);
    }
    CHECK(oracle::attenuation(smooth(1), 0, 1e6) == 1);  // radius 0: no attenuation
}

TEST_CASE(
    "light: no falloff increases with distance, and each ends at the radius"
    * technique("light.attenuation")) {
    for (const Attenuation& a :
         {Attenuation{}, polynomial(1, 0.7f, 1.8f), smooth(3),
          Attenuation{.falloff = Falloff::None}}) {
        double last = INFINITY;
        for (double d = 0; d < 6; d += 0.01) {
            const double value = oracle::attenuation(a, 5, d);
            CHECK(value <= last);
            last = value;
        }
        CHECK(oracle::attenuation(a, 5, 5.0001) == 0);
    }
}

TEST_CASE(
    "light: spot profiles have the values of light.spot-falloff"
    * technique("light.spot-falloff")) {
    const auto value = [](SpotProfile p, double angle) {
        return oracle::spot_factor(p, deg(20), deg(30), deg(angle));
    };
    CHECK(value(SpotProfile::LinearCosine, 25) == test::near(0.546816).epsilon(1e-5));
    CHECK(value(SpotProfile::Smoothstep, 25) == test::near(0.570018).epsilon(1e-5));
    CHECK(value(SpotProfile::LinearAngle, 25) == test::near(0.5));
    for (const SpotProfile p :
         {SpotProfile::LinearCosine, SpotProfile::Smoothstep, SpotProfile::LinearAngle}) {
        CHECK(value(p, 0) == 1);
        CHECK(value(p, 19.99) == 1);
        CHECK(value(p, 30.01) == 0);
        CHECK(value(p, 120) == 0);
        double last = 1;
        for (double angle = 0; angle < 40; angle += 0.05) {
            CHECK(value(p, angle) <= last);
            CHECK(last - value(p, angle) < 0.02);  // continuous
            last = value(p, angle);
        }
        // Equal cones: the hard edge of light.spot-cone.
        CHECK(oracle::spot_factor(p, deg(30), deg(30), deg(29.9)) == 1);
        CHECK(oracle::spot_factor(p, deg(30), deg(30), deg(30.1)) == 0);
    }
}

TEST_CASE(
    "light: lit has no specular term where the light is below the horizon"
    * technique("light.lit")) {
    CHECK(oracle::lit(0.5, 0.8, 2).diffuse == 0.5);
    CHECK(oracle::lit(0.5, 0.8, 2).specular == test::near(0.64));
    CHECK(oracle::lit(-0.1, 0.8, 2).diffuse == 0);
    CHECK(oracle::lit(-0.1, 0.8, 2).specular == 0);
    CHECK(oracle::lit(0.5, -0.1, 2).diffuse == 0.5);
    CHECK(oracle::lit(0.5, -0.1, 2).specular == 0);
    CHECK(oracle::lit(0, 1, 8).specular == 0);
}

TEST_CASE(
    "light: the local reflection model has the values of light.phong-model"
    * technique("fakephong.illum-phong, light.phong-model")) {
    const oracle::ClassicMaterial m;  // ka .1, kd .6, ks .3
    const auto from = [](double angle) {
        return DVec3(std::sin(deg(angle)), 0, std::cos(deg(angle)));
    };
    const auto phong = [&](double light, double eye, double n, double intensity) {
        oracle::ClassicMaterial material = m;
        material.shininess = n;
        const oracle::Arriving one = {from(light), DVec3(intensity)};
        return oracle::phong(material, DVec3(1), {&one, 1}, kUp, from(eye)).x;
    };
    for (const double n : {1.0, 20.0, 100.0}) {
        CHECK(phong(0, 0, n, 1) == test::near(1));
        CHECK(phong(60, -60, n, 1) == test::near(0.7));
        CHECK(phong(100, -60, n, 1) == test::near(0.1));
    }
    CHECK(phong(30, 10, 20, 3) - 0.1 == test::near(3 * (phong(30, 10, 20, 1) - 0.1)));
    // Where the lobe has fallen to a half.
    const std::array<std::array<double, 2>, 6> widths = {
        {{1, 60.0}, {5, 29.48}, {10, 21.09}, {20, 15.0}, {50, 9.52}, {100, 6.74}}};
    for (const auto& [n, angle] : widths) {
        CHECK(std::pow(std::cos(deg(angle)), n) == test::near(0.5).epsilon(2e-3));
        CHECK(phong(0, angle, n, 1) == test::near(0.1 + 0.6 + 0.15).epsilon(1e-3));
    }
}

TEST_CASE(
    "light: the halfway vector has the values of light.halfway-vector"
    * technique("fakephong.vectors, light.halfway-vector")) {
    oracle::ClassicMaterial m = {
        .ambient = DVec3(0), .diffuse = DVec3(0), .specular = DVec3(1), .shininess = 20};
    const auto from = [](double angle) {
        return DVec3(std::sin(deg(angle)), 0, std::cos(deg(angle)));
    };
    const auto blinn = [&](double light, double eye) {
        const oracle::Arriving one = {from(light), DVec3(1)};
        return oracle::blinn(m, DVec3(0), {&one, 1}, kUp, from(eye)).x;
    };
    const auto phong = [&](double light, double eye) {
        const oracle::Arriving one = {from(light), DVec3(1)};
        return oracle::phong(m, DVec3(0), {&one, 1}, kUp, from(eye)).x;
    };
    CHECK(blinn(0, 30) == test::near(0.4999).epsilon(1e-3));
    CHECK(phong(0, 30) == test::near(0.0563).epsilon(1e-2));
    CHECK(blinn(25, -50) == test::near(blinn(-50, 25)));
    // The angle to the half vector is half the angle to the mirrored one.
    for (const double eye : {-40.0, -10.0, 35.0}) {
        CHECK(
            std::acos(std::pow(blinn(20, eye), 1 / 20.0)) * 2
            == test::near(deg(std::abs(eye + 20))));
    }
    m.shininess = 80;
    CHECK(blinn(0, 30) == test::near(0.0624).epsilon(1e-2));
    m.shininess = 4;
    CHECK(blinn(60, 60) == test::near(0.0625));
    CHECK(phong(60, 60) == 0);
}

TEST_CASE("light: reflection does not depend on the type of light" * technique("light.interface")) {
    std::vector<std::string> files = {"lib/reflector.glsl"};
    for (const ShadingModelRow& row : kShadingModels) {
        files.push_back(std::string("shade_") + row.name + ".glsl");
    }
    for (const std::string& file : files) {
        CAPTURE(file);
        const auto text = gpu::ShaderFiles::standard().read(file);
        REQUIRE(text);
        for (const char* type : {"directional", "Directional", "spot", "Spot", "point light"}) {
            CHECK(text->find(type) == std::string::npos);
        }
    }
}

// ---- on the GPU
// ----------------------------------------------------------------------------------

TEST_CASE(
    "light: a matte plane under a point light is the closed form to 1e-3"
    * technique("light.point")) {
    // albedo / pi * I cos / d^2, the light 0.8 m above the center.
    PlaneScene scene(matte({0.8f, 0.5f, 0.2f}));
    scene.shine(
        PointLight{.color = {1, 0.5f, 0.25f}, .intensity = 7, .radius = 0}, at({0.0f, 0.0f, 0.8f}));
    const gpu::FloatImage image = scene.picture();
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const DVec3 offset = DVec3(0, 0, 0.8) - DVec3(plane_point(x, y, kSide));
            const double d2 = glm::dot(offset, offset);
            const DVec3 want =
                DVec3(0.8, 0.5 * 0.5, 0.2 * 0.25) * (7 / kPiD * (0.8 / std::sqrt(d2)) / d2);
            const DVec3 got = rgb_at(image, x, y);
            for (int c = 0; c < 3; ++c) {
                CHECK(std::abs(got[c] / want[c] - 1) <= 1e-3);
            }
        }
    }
}

TEST_CASE(
    "light: every falloff on the GPU equals the oracle"
    * technique("engine.light-falloff, light.attenuation")) {
    for (const Attenuation& a :
         {Attenuation{}, polynomial(1, 0.7f, 1.8f), polynomial(0, 1, 0), smooth(1), smooth(2.5f),
          Attenuation{.falloff = Falloff::None}}) {
        for (const float radius : {0.0f, 0.9f, 3.0f}) {
            PlaneScene scene;
            const PointLight light = {
                .color = {1, 0.6f, 0.3f}, .intensity = 2, .radius = radius, .attenuation = a};
            scene.shine(light, at({0.3f, -0.2f, 0.5f}));
            CAPTURE(static_cast<int>(a.falloff));
            CAPTURE(radius);
            CHECK(
                deviation(
                    scene.picture(),
                    [&](const Vec3& p) {
                        const oracle::Arriving one =
                            oracle::arrive(light, {0.3, -0.2, 0.5}, DVec3(p), kUp);
                        return oracle::blinn(
                            as_oracle(matte({1, 1, 1})), DVec3(0), {&one, 1}, kUp,
                            glm::normalize(kEye - DVec3(p)));
                    })
                <= 1e-3);
        }
    }
}

TEST_CASE(
    "light: every spot profile on the GPU equals the oracle" * technique("light.spot-falloff")) {
    for (const SpotProfile profile :
         {SpotProfile::LinearCosine, SpotProfile::Smoothstep, SpotProfile::LinearAngle}) {
        PlaneScene scene;
        const SpotLight light = {
            .intensity = 3,
            .radius = 0,
            .inner_angle = radians(15),
            .outer_angle = radians(35),
            .profile = profile};
        const Vec3 position = {0.4f, 0.3f, 0.9f};
        const Vec3 target = {-0.1f, 0.1f, 0};
        scene.shine(light, look_at(position, target));
        const DVec3 axis = glm::normalize(DVec3(target) - DVec3(position));
        CAPTURE(static_cast<int>(profile));
        CHECK(
            deviation(
                scene.picture(),
                [&](const Vec3& p) {
                    const oracle::Arriving one =
                        oracle::arrive(light, DVec3(position), axis, DVec3(p), kUp);
                    return oracle::blinn(
                        as_oracle(matte({1, 1, 1})), DVec3(0), {&one, 1}, kUp,
                        glm::normalize(kEye - DVec3(p)));
                })
            <= 1e-3);
    }
}

TEST_CASE(
    "light: a hard spot lights a disc of radius h tan(theta), and nothing behind it"
    * technique("light.spot-cone")) {
    PlaneScene scene;
    scene.shine(
        SpotLight{
            .radius = 0,
            .attenuation = {.falloff = Falloff::None},
            .inner_angle = radians(30),
            .outer_angle = radians(30)},
        look_at({0, 0, 1}, {0, 0, 0}));
    const gpu::FloatImage image = scene.picture();
    const float disc = std::tan(radians(30));
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float r = glm::length(plane_point(x, y, kSide));
            if (std::abs(r - disc) > 0.01f) {
                CHECK((image.at(x, y, 0) > 0) == (r < disc));
            }
        }
    }
    PlaneScene turned;
    turned.shine(SpotLight{.radius = 0}, look_at({0, 0, 1}, {0, 0, 2}));
    CHECK(largest_difference(turned.picture(), PlaneScene().picture()) == 0);
}

TEST_CASE(
    "light: Phong and Blinn highlights on the GPU equal the oracle"
    * technique(
        "fakephong.illum-blinn, fakephong.illum-phong, light.halfway-vector, light.phong-model")) {
    for (const ShadingModel model : {ShadingModel::Phong, ShadingModel::Blinn}) {
        for (const float shininess : {1.0f, 12.0f, 80.0f}) {
            Material material = {
                .shading = model,
                .base_color = {0.6f, 0.3f, 0.1f, 1},
                .specular = {0.3f, 0.5f, 0.7f},
                .shininess = shininess};
            PlaneScene scene(material);
            const PointLight light = {.color = {1, 0.8f, 0.6f}, .intensity = 5, .radius = 0};
            scene.shine(light, at({0.6f, 0.4f, 0.7f}));
            CAPTURE(static_cast<int>(model));
            CAPTURE(shininess);
            CHECK(
                deviation(
                    scene.picture(),
                    [&](const Vec3& p) {
                        const oracle::Arriving one =
                            oracle::arrive(light, {0.6, 0.4, 0.7}, DVec3(p), kUp);
                        const DVec3 to_eye = glm::normalize(kEye - DVec3(p));
                        return model == ShadingModel::Phong
                                   ? oracle::phong(
                                       as_oracle(material), DVec3(0), {&one, 1}, kUp, to_eye)
                                   : oracle::blinn(
                                       as_oracle(material), DVec3(0), {&one, 1}, kUp, to_eye);
                    })
                <= 2e-3);
        }
    }
}

TEST_CASE(
    "light: metal-rough highlights on the GPU equal the oracle" * technique("light.microfacet")) {
    for (const float metalness : {0.0f, 1.0f}) {
        for (const float roughness : {0.2f, 0.5f, 1.0f}) {
            PlaneScene scene(
                {.base_color = {0.9f, 0.6f, 0.3f, 1},
                 .metalness = metalness,
                 .roughness = roughness});
            const PointLight light = {.intensity = 5, .radius = 0};
            scene.shine(light, at({0.5f, 0.3f, 0.7f}));
            const oracle::PbrMaterial material = {{0.9f, 0.6f, 0.3f}, metalness, roughness};
            CAPTURE(metalness);
            CAPTURE(roughness);
            CHECK(
                deviation(
                    scene.picture(),
                    [&](const Vec3& p) {
                        const oracle::Arriving one =
                            oracle::arrive(light, {0.5, 0.3, 0.7}, DVec3(p), kUp);
                        const DVec3 to_eye = glm::normalize(kEye - DVec3(p));
                        const auto lobe = oracle::directional_albedo(to_eye.z, roughness, 1024);
                        return kPiD * one.color
                               * oracle::reflect_pbr(material, lobe, kUp, to_eye, one.to_light);
                    })
                <= 5e-3);  // roughness and color are stored in 10 and 12 bits
        }
    }
}

TEST_CASE("light: a light behind a shiny plane adds nothing, at any grazing angle") {
    for (const ShadingModel model : {ShadingModel::Phong, ShadingModel::Blinn, ShadingModel::Pbr}) {
        Scene scene;
        const Material shiny = {
            .shading = model, .roughness = 0.3f, .specular = {1, 1, 1}, .shininess = 2};
        scene.place(scene.add(make_square()), scene.add(shiny), at({0, 0, 0}));
        scene.shine(PointLight{.intensity = 100}, at({0, 0.8f, -0.1f}));
        for (const float value : scene.radiance(scene.look({0, -1.5f, 0.3f}, {0, 0, 0})).pixels) {
            CHECK((value == 0 || value == 1));  // nothing, or alpha
        }
    }
}

TEST_CASE("light: twice the light is twice the radiance" * technique("light.multi")) {
    PlaneScene scene({.base_color = {0.7f, 0.5f, 0.3f, 1}, .roughness = 0.3f});
    const Entity lamp = scene.shine(PointLight{.intensity = 4}, at({0.3f, 0.1f, 0.6f}));
    const gpu::FloatImage once = scene.picture();
    scene.world.get<PointLight>(lamp).intensity = 8;
    const gpu::FloatImage twice = scene.picture();
    for (std::size_t i = 0; i < once.pixels.size(); ++i) {
        if (i % 4 != 3) {
            CHECK(twice.pixels[i] == test::near(2 * once.pixels[i]).epsilon(1e-3));
        }
    }
}

TEST_CASE(
    "light: lights of all types add up, in any order"
    * technique("deferred.light-pass, light.interface, light.multi")) {
    const Material material = {.base_color = {0.7f, 0.5f, 0.3f, 1}, .roughness = 0.4f};
    const PointLight lamp = {.color = {1, 0.2f, 0.2f}, .intensity = 3};
    const SpotLight spot = {.color = {0.2f, 1, 0.2f}, .intensity = 6};
    const DirectionalLight sun = {.color = {0.2f, 0.2f, 1}, .illuminance = 2};
    const Affine lamp_at = at({0.4f, 0.2f, 0.5f});
    const Affine spot_at = look_at({-0.4f, 0.5f, 0.9f}, {0, 0, 0});
    const Affine sun_at = look_at({1, 1, 2}, {0, 0, 0});
    const auto picture = [&](auto&& add_lights) {
        PlaneScene scene(material);
        add_lights(scene);
        return scene.picture();
    };
    const auto first = picture([&](PlaneScene& s) { s.shine(lamp, lamp_at); });
    const auto second = picture([&](PlaneScene& s) { s.shine(spot, spot_at); });
    const auto third = picture([&](PlaneScene& s) { s.shine(sun, sun_at); });
    const auto all = picture([&](PlaneScene& s) {
        s.shine(lamp, lamp_at);
        s.shine(spot, spot_at);
        s.shine(sun, sun_at);
    });
    const auto reversed = picture([&](PlaneScene& s) {
        s.shine(sun, sun_at);
        s.shine(spot, spot_at);
        s.shine(lamp, lamp_at);
    });
    for (std::size_t i = 0; i < all.pixels.size(); ++i) {
        if (i % 4 != 3) {
            CHECK(
                all.pixels[i]
                == test::near(first.pixels[i] + second.pixels[i] + third.pixels[i]).epsilon(2e-3));
        }
    }
    CHECK(largest_difference(all, reversed) <= 1e-6f);

    const auto copies = picture([&](PlaneScene& s) {
        for (int i = 0; i < 5; ++i) {
            s.shine(lamp, lamp_at);
        }
    });
    for (std::size_t i = 0; i < copies.pixels.size(); i += 4) {
        CHECK(copies.pixels[i] == test::near(5 * first.pixels[i]).epsilon(2e-3));
    }
}

TEST_CASE(
    "light: off and on again restores every bit; off leaves the image of the other light"
    * technique("engine.light-object, light.unified")) {
    PlaneScene scene;
    const Entity one = scene.shine(PointLight{}, at({0.3f, 0.1f, 0.6f}));
    const gpu::FloatImage alone = scene.picture();
    const Entity other = scene.shine(PointLight{.color = {0, 1, 0}}, at({-0.3f, 0.1f, 0.6f}));
    const gpu::FloatImage both = scene.picture();
    CHECK(largest_difference(alone, both) > 0.01f);

    scene.world.get<PointLight>(other).enabled = false;
    CHECK(largest_difference(scene.picture(), alone) == 0);
    CHECK(scene.draw(scene.view()).statistics.lights == 1);
    scene.world.get<PointLight>(other).enabled = true;
    CHECK(largest_difference(scene.picture(), both) == 0);
    scene.world.destroy(other);
    CHECK(largest_difference(scene.picture(), alone) == 0);
    scene.world.destroy(one);
    CHECK(largest_difference(scene.picture(), PlaneScene().picture()) == 0);
}

TEST_CASE("light: without lights only the environment lights" * technique("light.multi")) {
    PlaneScene scene(matte({0.5f, 0.5f, 0.5f}));
    CHECK(scene.picture().at(5, 5, 0) == 0);
    scene.world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {0.4f, 0.6f, 0.8f}});
    const gpu::FloatImage image = scene.picture();
    CHECK(image.at(5, 5, 0) == test::near(0.2).epsilon(2e-3));
    CHECK(image.at(5, 5, 1) == test::near(0.3).epsilon(2e-3));
    CHECK(image.at(5, 5, 2) == test::near(0.4).epsilon(2e-3));
}

TEST_CASE(
    "light: a directional light is the same everywhere, and the limit of a far point light"
    * technique("light.directional")) {
    PlaneScene scene;
    const Vec3 from = glm::normalize(Vec3(1, 2, 3));
    const Entity sun = scene.shine(DirectionalLight{.illuminance = 2}, look_at(from, {0, 0, 0}));
    const gpu::FloatImage near = scene.picture();
    const float want = 2 / kPi * from.z;
    for (int i = 0; i < kSide; ++i) {
        CHECK(near.at(i, kSide - 1 - i, 0) == test::near(want).epsilon(1e-3));
    }
    scene.world.destroy(sun);
    scene.shine(
        PointLight{.intensity = 2, .radius = 0, .attenuation = {.falloff = Falloff::None}},
        at(from * 1e4f));
    CHECK(largest_difference(scene.picture(), near) <= 1e-3f);
}

TEST_CASE("light: moving light and plane together changes nothing" * technique("light.point")) {
    const auto picture = [](const Vec3& offset) {
        Scene scene;
        scene.place(scene.add(make_square()), scene.add(matte({1, 1, 1})), at(offset));
        scene.shine(PointLight{}, at(offset + Vec3(0.3f, 0.1f, 0.6f)));
        return scene.radiance(scene.look(offset + Vec3(0, 0, 1), offset, kSide, kSide));
    };
    CHECK(largest_difference(picture({0, 0, 0}), picture({8, -4, 16})) <= 2e-2f);
    // One h aside of a light h above the plane the cosine is 0.7071.
    Scene scene;
    scene.place(scene.add(make_square()), scene.add(matte({1, 1, 1})), at({0, 0, 0}));
    scene.shine(
        PointLight{.intensity = kPi, .radius = 0, .attenuation = {.falloff = Falloff::None}},
        at({-0.5f, 0, 0.5f}));
    const gpu::FloatImage image = scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 33, 33));
    CHECK(image.at(16, 16, 0) == test::near(0.7071).epsilon(2e-3));
}

TEST_CASE("light: nothing is lit beyond the radius" * technique("engine.light-object")) {
    PlaneScene scene;
    scene.shine(PointLight{.intensity = 100, .radius = 0.8f}, at({0, 0, 0.5f}));
    const gpu::FloatImage image = scene.picture();
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float d = glm::distance(plane_point(x, y, kSide), Vec3(0, 0, 0.5f));
            if (d > 0.8f) {
                CHECK(image.at(x, y, 0) == 0);
            } else if (d < 0.75f) {
                CHECK(image.at(x, y, 0) > 0);
            }
        }
    }
}

TEST_CASE(
    "light: a pulse modulates the intensity and never makes it negative"
    * technique("engine.light-object")) {
    const auto pulsing = [](const PeriodicFunction& function) {
        return LightPulse{.function = function};
    };
    const LightPulse pulse = pulsing({.base = 1, .amplitude = 0.5f, .phase = 0.1f, .frequency = 2});
    CHECK(pulse_factor(pulse, 0) == test::near(1 + 0.5 * std::sin(0.2 * kPiD)));
    CHECK(pulse_factor(pulse, 1.7) == test::near(1 + 0.5 * std::sin(7 * kPiD)));
    const LightPulse deep = pulsing({.base = 1, .amplitude = 3});
    CHECK(pulse_factor(deep, 0.75) == 0);

    PlaneScene scene;
    scene.world.insert_resource(FrameTime{.time = 0});
    const Entity lamp = scene.shine(PointLight{}, at({0, 0, 0.6f}));
    const float steady = scene.picture().at(9, 9, 0);
    scene.world.add(lamp, pulsing({.base = 1, .amplitude = 1}));
    scene.world.resource<FrameTime>().time = 0.25;
    CHECK(scene.picture().at(9, 9, 0) == test::near(2 * steady).epsilon(1e-3));
}

TEST_CASE(
    "light: a pulse blends the color toward another one, not beyond it"
    * technique("engine.periodic")) {
    PlaneScene scene;
    scene.world.insert_resource(FrameTime{.time = 0});
    const Entity lamp = scene.shine(PointLight{.color = {1, 0, 0}}, at({0, 0, 0.6f}));
    const float red = scene.picture().at(9, 9, 0);
    scene.world.add(
        lamp, LightPulse{
                  .function = constant_function(1),
                  .color = {0, 0, 1},
                  .color_function = {.base = 0.5f, .amplitude = 2}});
    CHECK(scene.picture().at(9, 9, 0) == test::near(0.5 * red).epsilon(1e-3));
    CHECK(scene.picture().at(9, 9, 2) == test::near(0.5 * red).epsilon(1e-3));
    scene.world.resource<FrameTime>().time = 0.25;
    CHECK(scene.picture().at(9, 9, 0) == test::near(0).scale(red));
    CHECK(scene.picture().at(9, 9, 2) == test::near(red).epsilon(1e-3));
}

TEST_CASE("light: invalid lights are skipped" * technique("light.directional")) {
    PlaneScene scene;
    const gpu::FloatImage dark = scene.picture();
    scene.shine(PointLight{.color = {NAN, 1, 1}}, at({0, 0, 1}));
    scene.shine(PointLight{.intensity = -5}, at({0, 0, 1}));
    scene.shine(PointLight{.intensity = INFINITY}, at({0, 0, 1}));
    scene.shine(PointLight{.color = {0, 0, 0}}, at({0, 0, 1}));
    scene.shine(SpotLight{}, at({NAN, 0, 1}));
    scene.shine(PointLight{.radius = NAN}, at({0, 0, 1}));
    scene.shine(SpotLight{.outer_angle = NAN}, at({0, 0, 1}));
    CHECK(scene.draw(scene.view()).statistics.lights == 0);
    CHECK(largest_difference(scene.picture(), dark) == 0);
    // Swapped cones make a hard edge; a negative radius is unbounded.
    scene.shine(
        SpotLight{.radius = -1, .inner_angle = radians(60), .outer_angle = radians(20)},
        look_at({0, 0, 1}, {0, 0, 0}));
    const gpu::FloatImage spot = scene.picture();
    CHECK(spot.at(kSide / 2, kSide / 2, 0) > 0);
    CHECK(spot.at(0, 0, 0) == 0);
}

TEST_CASE(
    "light: a light in the plane itself adds nothing and does no harm" * technique("light.point")) {
    PlaneScene scene;
    scene.shine(PointLight{}, at(plane_point(7, 9, kSide)));
    for (const float value : scene.picture().pixels) {
        CHECK(std::isfinite(value));
    }
}

}  // namespace limn::test::light_test
