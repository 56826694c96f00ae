#include "bench/oracles/pbr_oracle.h"
#include "bench/oracles/skin_light_oracle.h"
#include "ecs/components/rendering.h"
#include "render/material/skin_tone.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

// Colors and reflection of skin (skin.blinn, skin.melanin-blood, skin.brdf-lafortune), against
// double precision.

namespace limn::test::skin_models_test {
namespace {

using oracle::DVec3;
using oracle::Lobe;

/// The synthetic sets of skin.brdf-lafortune.
struct LobeSet {
    DVec3 diffuse;
    std::array<Lobe, 2> lobes;
};
const LobeSet kSets[] = {
    {{0.60, 0.42, 0.33}, {{{-0.95, 0.95, 20}, {-0.55, 0.45, 4}}}},
    {{0.40, 0.26, 0.19}, {{{-0.98, 0.98, 40}, {-0.60, 0.50, 5}}}}};

Material measured_skin(const LobeSet& set) {
    Material material = {
        .shading = ShadingModel::Lafortune, .base_color = Vec4(Vec3(set.diffuse), 1)};
    for (const Lobe& lobe : set.lobes) {
        material.lobes.push_back(
            {.across = Vec3(static_cast<float>(lobe.across)),
             .along = Vec3(static_cast<float>(lobe.along)),
             .exponent = Vec3(static_cast<float>(lobe.exponent))});
    }
    return material;
}

Material pigmented(Pigments pigments, float melanin, float blood) {
    return {
        .shading = ShadingModel::Skin,
        .base_color = Vec4(1),
        .specular = {0.2f, 0.2f, 0.2f},
        .shininess = 20,
        .skin_color = {0, 0, 0},
        .pigments = pigments,
        .melanin = melanin,
        .blood = blood};
}

/// The center of a square that faces the camera, lit from `to_light` by the two intensities of
/// skin.blinn, Ia = 0.3 around and Il = 0.7.
Vec3 shaded(const Material& material, const Vec3& to_light) {
    Scene scene;
    scene.place(scene.add(make_square()), scene.add(material), at({0, 0, 0}));
    const Affine pose = look_at({0, 0, 0}, -to_light);
    scene.shine(DirectionalLight{.illuminance = 0.7f * kPi}, pose);
    scene.world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(0.3f)});
    return rgb_at(scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17)), 8, 8);
}

double off(const Vec3& found, const DVec3& exact) {
    return glm::length(DVec3(found) - exact);
}

}  // namespace

TEST_CASE(
    "skin tone: melanin and blood subtract the colors of the table"
    * technique("skin.melanin-blood")) {
    const double amounts[][2] = {{0, 0}, {0.2, 0.5}, {0.05, 0.2}, {0.5, 0.6}, {1, 0}, {1, 1}};
    for (const auto& [melanin, blood] : amounts) {
        const Vec3 tone = skin_tone(
            pigmented(Pigments::Plane, static_cast<float>(melanin), static_cast<float>(blood)));
        CHECK(off(tone, glm::max(oracle::melanin_blood(melanin, blood), 0.0)) < 1e-6);
    }
    CHECK(off(skin_tone(pigmented(Pigments::Plane, 0.2f, 0.5f)), {0.832, 0.608, 0.370}) < 1e-6);
    CHECK(off(skin_tone(pigmented(Pigments::Plane, 1, 1)), {0.28, 0, 0}) < 1e-6);
    CHECK(skin_tone(pigmented(Pigments::None, 1, 1)) == Vec3(1));
}

TEST_CASE(
    "skin tone: densities match the albedo of each skin type within a fifth"
    * technique("skin.melanin-blood")) {
    const Vec3 types[] = {
        {0.55f, 0.34f, 0.26f},
        {0.46f, 0.27f, 0.19f},
        {0.35f, 0.19f, 0.12f},
        {0.22f, 0.11f, 0.066f},
        {0.12f, 0.06f, 0.04f}};
    float last = -1;
    for (const Vec3& type : types) {
        float best = 1e9f;
        float at_melanin = 0;
        for (int i = 0; i <= 100; ++i) {
            const float melanin = 0.01f * static_cast<float>(i);
            const Vec3 tone = skin_tone(pigmented(Pigments::Density, melanin, 0.2f));
            const Vec3 apart = glm::abs(tone / type - 1.0f);
            const float most = std::max({apart.x, apart.y, apart.z});
            if (most < best) {
                best = most;
                at_melanin = melanin;
            }
        }
        CHECK(best < 0.2f);
        CHECK(at_melanin > last);
        last = at_melanin;
    }
}

TEST_CASE(
    "skin tone: blood reddens, and at both ends nothing is negative or brighter than white"
    * technique("skin.melanin-blood")) {
    for (const Pigments pigments : {Pigments::Plane, Pigments::Density}) {
        const Vec3 pale = skin_tone(pigmented(pigments, 0.1f, 0));
        const Vec3 blushing = skin_tone(pigmented(pigments, 0.1f, 1));
        CHECK(blushing.x / blushing.y > 1.2f * pale.x / pale.y);
        for (const float melanin : {0.0f, 1.0f}) {
            for (const float blood : {0.0f, 1.0f}) {
                const Vec3 tone = skin_tone(pigmented(pigments, melanin, blood));
                CHECK(glm::all(glm::greaterThanEqual(tone, Vec3(0))));
                CHECK(glm::all(glm::lessThanEqual(tone, Vec3(1))));
            }
        }
    }
}

TEST_CASE(
    "skin blinn: the hand preset, viewed and lit along the normal, has the printed color"
    * technique("skin.blinn")) {
    CHECK(
        off(shaded(pigmented(Pigments::Plane, 0.2f, 0.5f), {0, 0, 1}), DVec3(0.972, 0.748, 0.510))
        < 2e-3);
}

TEST_CASE(
    "skin blinn: with a light below the horizon only ambient light is left"
    * technique("skin.blinn")) {
    CHECK(
        off(shaded(pigmented(Pigments::Plane, 0.2f, 0.5f), glm::normalize(Vec3(1, 0, -0.2f))),
            0.3 * DVec3(0.832, 0.608, 0.370))
        < 1e-3);
}

TEST_CASE(
    "skin blinn: without gloss it looks the same from every direction" * technique("skin.blinn")) {
    Scene scene;
    Material matte = pigmented(Pigments::Plane, 0.2f, 0.5f);
    matte.specular = Vec3(0);
    scene.place(scene.add(make_square()), scene.add(matte), at({0, 0, 0}));
    scene.shine(DirectionalLight{.illuminance = 2}, look_at({1, 2, 3}, {0, 0, 0}));
    const Vec3 first = rgb_at(scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17)), 8, 8);
    const Vec3 second =
        rgb_at(scene.radiance(scene.look({1, 0.3f, 0.4f}, {0, 0, 0}, 17, 17)), 8, 8);
    CHECK(glm::distance(first, second) < 1e-4f);
    CHECK(first.x > 0.1f);
}

TEST_CASE_FIXTURE(
    RenderTest, "skin brdf: lobes are those of double precision, and reciprocal"
                    * technique("skin.brdf-lafortune")) {
    std::vector<Vec4> inputs;
    std::vector<double> expected;
    const LobeSet& set = kSets[0];
    for (int i = 0; i < 400; ++i) {
        const auto direction = [](int n) {
            const double z = std::fmod(n * 0.6180339887498949, 1.0);
            const double turn = 2.4 * n;
            const double r = std::sqrt(1 - z * z);
            return DVec3(r * std::cos(turn), r * std::sin(turn), z);
        };
        const DVec3 u = direction(i + 1);
        const DVec3 v = direction(3 * i + 2);
        inputs.emplace_back(u.z, v.z, glm::dot(u, v), 0);
        expected.push_back(oracle::lafortune(0, set.lobes, u, v));
        CHECK(std::abs(oracle::lafortune(0, set.lobes, v, u) - expected.back()) < 1e-12);
        // Turned about the normal by a right angle.
        CHECK(
            std::abs(
                oracle::lafortune(0, set.lobes, {-u.y, u.x, u.z}, {-v.y, v.x, v.z})
                - expected.back())
            < 1e-12);
    }
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/brdf.glsl\"\n#include \"lib/lafortune.glsl\"\n",
        "y.x = lafortune_lobe(vec3(-0.95), vec3(0.95), vec3(20.0), x.x, x.y, x.z).g"
        " + lafortune_lobe(vec3(-0.55), vec3(0.45), vec3(4.0), x.x, x.y, x.z).b;"
        "y.y = lafortune_lobe(vec3(-1.0), vec3(1.0), vec3(7.0), x.x, x.y, x.z).r;"
        "y.z = lafortune_lobe(vec3(-0.95), vec3(0.95), vec3(20.0), x.y, x.x, x.z).g"
        " + lafortune_lobe(vec3(-0.55), vec3(0.45), vec3(4.0), x.y, x.x, x.z).b;",
        inputs);
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(std::abs(static_cast<double>(found[i].x) - expected[i]) < 1e-4);
        CHECK(found[i].x == found[i].z);
        CHECK(found[i].y <= 1.0001f);
    }
}

TEST_CASE(
    "skin brdf: along the normal, the first set adds 0.399492 to its base color"
    * technique("skin.brdf-lafortune")) {
    const Vec3 color = shaded(measured_skin(kSets[0]), {0, 0, 1});
    const DVec3 expected = 0.3 * kSets[0].diffuse + 0.7 * (kSets[0].diffuse + 0.399492);
    CHECK(off(color, expected) < 3e-3);
}

TEST_CASE(
    "skin brdf: every light direction matches the oracle" * technique("skin.brdf-lafortune")) {
    for (const LobeSet& set : kSets) {
        for (const DVec3 to_light : {DVec3(0.3, 0.2, 0.9), DVec3(0.8, 0, 0.3), DVec3(1, 0, -0.3)}) {
            const DVec3 u = glm::normalize(to_light);
            DVec3 expected = 0.3 * set.diffuse;
            for (int c = 0; c < 3; ++c) {
                expected[c] += 0.7 * oracle::lafortune(set.diffuse[c], set.lobes, u, {0, 0, 1})
                               * std::max(u.z, 0.0);
            }
            CHECK(off(shaded(measured_skin(set), Vec3(u)), expected) < 3e-3);
        }
    }
}

TEST_CASE(
    "skin brdf: without lobes it is Lambertian, with the base color"
    * technique("skin.brdf-lafortune")) {
    Material bare = measured_skin(kSets[0]);
    bare.lobes.clear();
    const Vec3 to_light = glm::normalize(Vec3(0.4f, 0.1f, 0.5f));
    CHECK(off(shaded(bare, to_light), (0.3 + 0.7 * to_light.z) * kSets[0].diffuse) < 2e-3);
}

TEST_CASE("skin brdf: neither set reflects more light than it receives, from any direction") {
    for (const LobeSet& set : kSets) {
        for (const double z : {0.02, 0.1, 0.3, 0.6, 1.0}) {
            const DVec3 u(std::sqrt(1 - z * z), 0, z);
            const double albedo = oracle::lafortune_albedo(set.diffuse.x, set.lobes, u);
            CHECK(albedo < 1);
            CHECK(albedo > set.diffuse.x);
        }
    }
}

TEST_CASE(
    "subsurface gloss: highlights are the two lobes of GGX, each with its weight"
    * technique("skin.gloss")) {
    Material black = {
        .shading = ShadingModel::Subsurface,
        .base_color = {0, 0, 0, 1},
        .roughness = 0.55f,
        .specular = Vec3(0.028f),
        .gloss = 0.3f,
        .gloss_roughness = 0.35f};
    for (const Vec3& toward : {Vec3(0, 0, 1), Vec3(0.4f, 0, 1), Vec3(1, 0.5f, 0.6f)}) {
        Scene scene;
        const Vec3 to_light = glm::normalize(toward);
        scene.place(scene.add(make_square()), scene.add(black), at({0, 0, 0}));
        scene.shine(DirectionalLight{.illuminance = 2}, look_at({0, 0, 0}, -to_light));
        const float found = scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17)).at(8, 8, 0);
        const DVec3 l = DVec3(to_light);
        const DVec3 h = glm::normalize(l + DVec3(0, 0, 1));
        const double lobe = 0.7 * oracle::ggx_lobe(l.z, 1, h.z, square(0.55))
                            + 0.3 * oracle::ggx_lobe(l.z, 1, h.z, square(0.35));
        const double fresnel = 0.028 + (1 - 0.028) * std::pow(1 - h.z, 5);
        CHECK(static_cast<double>(found) == near(2 * lobe * fresnel).epsilon(5e-3));
    }
}

TEST_CASE(
    "subsurface gloss: white skin in white light is white, and none is brighter"
    * technique("skin.gloss")) {
    for (const float gloss : {0.0f, 0.5f, 1.0f}) {
        for (const Vec3& eye : {Vec3(0, 0, 1), Vec3(1, 0, 0.3f)}) {
            Scene scene;
            scene.place(
                scene.add(make_square()),
                scene.add(Material{
                    .shading = ShadingModel::Subsurface,
                    .base_color = Vec4(1),
                    .specular = Vec3(0.028f),
                    .gloss = gloss}),
                at({0, 0, 0}));
            scene.world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(1)});
            const float found = scene.radiance(scene.look(eye, {0, 0, 0}, 17, 17)).at(8, 8, 1);
            CHECK(found <= 1.002f);
            CHECK(found > 0.98f);
        }
    }
}

TEST_CASE("detail: its slopes add to those of the normal map" * technique("skin.detail")) {
    // Normals of slope 1/4 along u and 1/3 along v.
    const auto map = [](const char* name, const Vec3& normal) {
        ImageData image{.name = name, .width = 1, .height = 1, .srgb = false, .pixels = {}};
        const Vec3 n = glm::normalize(normal);
        for (int c = 0; c < 3; ++c) {
            image.pixels.push_back(
                static_cast<std::uint8_t>(std::lround(255 * (0.5f + 0.5f * n[c]))));
        }
        image.pixels.push_back(255);
        return image;
    };
    Scene scene;
    Material material;
    material.normal_texture.image = scene.add(map("coarse", {0.25f, 0, 1}));
    material.detail_texture.image = scene.add(map("fine", {0, 1.0f / 3, 1}));
    material.detail_texture.scale = {8, 8};
    scene.place(scene.add(make_square()), scene.add(material), at({0, 0, 0}));
    const Vec3 found = rgb_at(scene.aov(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17), "normal"), 8, 8);
    CHECK(glm::distance(found, glm::normalize(Vec3(0.25f, 1.0f / 3, 1))) < 0.01f);
    // The alpha of vertex colors scales the slopes of the detail alone.
    MeshData shallow = make_square();
    shallow.colors.assign(shallow.positions.size(), Vec4(1, 1, 1, 0.5f));
    scene.place(scene.add(shallow), scene.add(material), at({0, 0, 0.1f}));
    const Vec3 half = rgb_at(scene.aov(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17), "normal"), 8, 8);
    CHECK(glm::distance(half, glm::normalize(Vec3(0.25f, 0.5f / 3, 1))) < 0.01f);
}

/// A square of skin before the camera, lit by a lamp or by uniform surroundings.
struct CavityScene {
    float alpha = 1;      ///< of vertex colors: 0.1 or more where skin is open
    float occlusion = 1;  ///< of the occlusion map
    Vec3 base_color = Vec3(0);
    bool lamp = true;
    ShadingRate shading = ShadingRate::Pixel;
};

float seen(const CavityScene& shown) {
    Scene scene;
    MeshData mesh = make_square();
    mesh.colors.assign(4, Vec4(1, 1, 1, shown.alpha));
    Material material = {
        .shading = ShadingModel::Subsurface,
        .base_color = Vec4(shown.base_color, 1),
        .roughness = 0.5f,
        .specular = Vec3(0.05f)};
    if (shown.occlusion < 1) {
        const auto open = static_cast<std::uint8_t>(std::lround(255 * shown.occlusion));
        material.occlusion_texture.image = scene.add(ImageData{
            .name = "occlusion",
            .width = 1,
            .height = 1,
            .srgb = false,
            .pixels = {open, open, open, 255}});
    }
    scene.place(scene.add(mesh), scene.add(material), at({0, 0, 0}));
    scene.world.insert_resource(Rendering{.shading = shown.shading});
    if (shown.lamp) {
        scene.shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, {0, 0, -1}));
    } else {
        scene.world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(1)});
    }
    return rgb_at(scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17)), 8, 8).x;
}

TEST_CASE(
    "skin: a cavity is lit by its share of the surroundings, and a deep one mirrors no lamp, at "
    "every shading rate") {
    for (const ShadingRate shading :
         {ShadingRate::Pixel, ShadingRate::Vertex, ShadingRate::Quadratic, ShadingRate::Taylor,
          ShadingRate::BlinnMap}) {
        CAPTURE(static_cast<int>(shading));
        const auto mirrored = [&](float alpha) {
            return static_cast<double>(seen({.alpha = alpha, .shading = shading}));
        };
        const auto around = [&](float alpha) {
            return static_cast<double>(seen(
                {.alpha = alpha, .base_color = Vec3(0.8f), .lamp = false, .shading = shading}));
        };
        const double open = mirrored(1);
        CHECK(open > 1e-3);
        CHECK(mirrored(0.1f) == near(open).epsilon(0.01));
        CHECK(mirrored(0.04f) == near(open).epsilon(0.01));  // lamps reach it
        CHECK(mirrored(0.0125f) == near(0.5 * open).epsilon(0.03));
        CHECK(mirrored(0) == 0);
        CHECK(around(0.1f) == near(around(1)).epsilon(0.01));
        CHECK(around(0.05f) < 0.52 * around(1));
        CHECK(around(0) < 1e-3 * around(1));
    }
}

TEST_CASE("skin: an occlusion map darkens the surroundings, not what skin mirrors of lamps") {
    const auto open = static_cast<double>(seen({}));
    for (const float occlusion : {0.5f, 0.1f, 0.0f}) {
        CHECK(static_cast<double>(seen({.occlusion = occlusion})) == near(open).epsilon(0.01));
    }
    CHECK(
        seen({.occlusion = 0.2f, .base_color = Vec3(0.8f), .lamp = false})
        < 0.25f * seen({.base_color = Vec3(0.8f), .lamp = false}));
    // Both at once.
    CHECK(seen({.alpha = 0, .occlusion = 0.5f}) == 0);
}

}  // namespace limn::test::skin_models_test
