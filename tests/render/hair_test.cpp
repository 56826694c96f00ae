#include "bench/oracles/hair_oracle.h"
#include "ecs/components/shadow.h"
#include "render/material/hair_lobes.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// The shading model Hair: its lobes against a fiber in double precision, and what surfaces do with
// them.

namespace limn::test::hair_test {
namespace {

using oracle::DVec3;

Material hair_of(const Vec3& color, float roughness, float across, float scatter, float tilt = 0) {
    return {
        .shading = ShadingModel::Hair,
        .base_color = Vec4(color, 1),
        .roughness = roughness,
        .roughness_across = across,
        .scale_tilt = tilt,
        .hair_scatter = scatter};
}

/// A direction by its inclination to the tip, +x, and its azimuth from +z [rad].
Vec3 direction(float inclination, float azimuth) {
    return {
        std::sin(inclination), std::cos(inclination) * std::sin(azimuth),
        std::cos(inclination) * std::cos(azimuth)};
}

std::string vec4_text(const Vec4& v) {
    return fmt::format("vec4({:.9e}, {:.9e}, {:.9e}, {:.9e})", v.x, v.y, v.z, v.w);
}

/// Light of a strand along +x: reflected in w, transmitted through it in xyz. Inputs hold the
/// inclination and the azimuth of light, then those of the viewer. The normal is +z. `lit`:
/// fraction of the light that other strands let through without scattering.
std::vector<Vec4>
strand_light(const Material& material, const std::vector<Vec4>& inputs, double lit = 1) {
    const layout::HairBlock block = make_hair_block(material);
    const std::string before = "#include \"lib/hair.glsl\"\n"
                               "vec3 toward(vec2 a) { return vec3(sin(a.x), cos(a.x) * sin(a.y), "
                               "cos(a.x) * cos(a.y)); }\n";
    const std::string body = fmt::format(
        "vec3 l = toward(x.xy); vec3 v = toward(x.zw);"
        "HairLobes hair = hair_lobes({}, {}, {}.rgb, {:.9e}, vec3(1.0, 0.0, 0.0), v);"
        "HairLight light = hair_light(hair, vec3(0.0, 0.0, 1.0), l, dot(l, v));"
        "y = vec4({:.9e} * light.transmitted + light.scattered, {:.9e} * light.reflected);",
        vec4_text(block.azimuth), vec4_text(block.fiber), vec4_text(material.base_color),
        material.roughness, lit, lit);
    return evaluate_shader(before, body, inputs);
}

/// In a half-space full of strands, viewed along its normal: the fraction of visible strands that
/// light at this cosine reaches, relative to light along the normal. By integration over depth.
double reached(double cosine) {
    constexpr double kStep = 1e-3;
    double lit = 0;
    double all = 0;
    for (double depth = 0.5 * kStep; depth < 20; depth += kStep) {
        lit += cosine > 0 ? std::exp(-depth - depth / cosine) : 0.0;
        all += std::exp(-2 * depth);
    }
    return lit / all;
}

/// Radiance of a strand viewed at an inclination under light of radiance 1 from all sides.
DVec3 furnace(const Material& material, float to_viewer) {
    constexpr int kSteps = 180;
    std::vector<Vec4> inputs;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            inputs.emplace_back(
                kPi * ((static_cast<float>(i) + 0.5f) / kSteps - 0.5f),
                2 * kPi * (static_cast<float>(j) + 0.5f) / kSteps, to_viewer, 0);
        }
    }
    const std::vector<Vec4> light = strand_light(material, inputs);
    DVec3 sum(0);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double area = std::cos(static_cast<double>(inputs[i].x));
        sum += (DVec3(light[i]) + static_cast<double>(light[i].w)) * area;
    }
    return sum * (2.0 * 9.8696044 / (kSteps * kSteps));
}

/// Inclination [rad] of the light for which `lobe` of a viewer at `to_viewer` is brightest.
float brightest(const Material& material, int lobe, float to_viewer) {
    const layout::HairBlock block = make_hair_block(material);
    std::vector<Vec4> inputs;
    for (int i = -8000; i <= 8000; ++i) {
        inputs.emplace_back(1e-4f * static_cast<float>(i), to_viewer, 0, 0);
    }
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/hair.glsl\"\n",
        fmt::format(
            "HairLobes hair = hair_lobes({}, {}, vec3(1.0), {:.9e}, vec3(1.0, 0.0, 0.0),"
            " vec3(sin(x.y), 0.0, cos(x.y)));"
            "y.x = longitudinal(hair.variance, sin(x.x), cos(x.x), hair.view_sine,"
            " hair.view_cosine)[{}];",
            vec4_text(block.azimuth), vec4_text(block.fiber), material.roughness, lobe),
        inputs);
    const auto most = std::max_element(
        found.begin(), found.end(), [](const Vec4& a, const Vec4& b) { return a.x < b.x; });
    return inputs[static_cast<std::size_t>(most - found.begin())].x;
}

/// Fraction of the light on a strand, viewed at an inclination, that TT holds.
Vec3 transmitted_fraction(const Material& material, float to_viewer) {
    const layout::HairBlock block = make_hair_block(material);
    return Vec3(evaluate_shader(
        "#include \"lib/hair.glsl\"\n",
        fmt::format(
            "y = vec4(hair_lobes({}, {}, {}.rgb, {:.9e}, vec3(1.0, 0.0, 0.0),"
            " vec3(sin(x.x), 0.0, cos(x.x))).tt, 0.0);",
            vec4_text(block.azimuth), vec4_text(block.fiber), vec4_text(material.base_color),
            material.roughness),
        {{to_viewer, 0, 0, 0}})[0]);
}

/// The center of a square whose strands run down, along v, viewed head on and lit from `to_light`.
Vec3 lit_square(const Material& material, const Vec3& to_light, const MeshData& mesh) {
    Scene scene;
    scene.place(scene.add(mesh), scene.add(material), at({0, 0, 0}));
    scene.shine(DirectionalLight{.illuminance = 1}, look_at({0, 0, 0}, -to_light));
    return rgb_at(scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17)), 8, 8);
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "hair lobes: white strands reflect all light, and none reflects more"
                    * technique("hair.shading")) {
    for (const float roughness : {0.1f, 0.3f, 0.7f}) {
        for (const float scatter : {0.0f, 1.0f}) {
            for (const float to_viewer : {0.0f, 0.6f, -1.2f}) {
                const Material white =
                    hair_of(Vec3(1), roughness, roughness, scatter, radians(3.0f));
                const double all = furnace(white, to_viewer).x;
                CAPTURE(roughness);
                CAPTURE(scatter);
                CAPTURE(to_viewer);
                CHECK(all < 1.01);
                CHECK(all > 0.98);
                const DVec3 brown =
                    furnace(hair_of({0.7f, 0.3f, 0.1f}, roughness, 0.3f, scatter), to_viewer);
                CHECK(brown.x < all);
                CHECK(brown.y < brown.x);
                CHECK(brown.z < brown.y);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "hair lobes: scales tilt highlights by -a, a / 2 and 3 a / 2" * technique("hair.shading")) {
    const float tilt = radians(5.0f);
    const Material hair = hair_of(Vec3(1), 0.1f, 0.3f, 0, tilt);
    for (const float to_viewer : {0.0f, 0.3f, -0.3f}) {
        const float shifts[] = {-tilt, 0.5f * tilt, 1.5f * tilt};
        for (int lobe = 0; lobe < 3; ++lobe) {
            const float half = 0.5f * (brightest(hair, lobe, to_viewer) + to_viewer);
            CAPTURE(lobe);
            CAPTURE(to_viewer);
            CHECK(std::abs(half - shifts[lobe]) < radians(0.35f));
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "hair lobes: light and viewer at equal inclinations are interchangeable"
                    * technique("hair.shading")) {
    const Material hair = hair_of({0.6f, 0.3f, 0.1f}, 0.3f, 0.3f, 0);
    std::vector<Vec4> inputs;
    std::vector<Vec4> swapped;
    for (int i = 0; i < 200; ++i) {
        const float a = 1.4f * std::sin(0.7f * static_cast<float>(i));
        const float b = i % 2 == 0 ? a : -a;
        const float around = 0.37f * static_cast<float>(i);
        inputs.emplace_back(a, around, b, 0.2f);
        swapped.emplace_back(b, 0.2f, a, around);
    }
    const std::vector<Vec4> one = strand_light(hair, inputs);
    const std::vector<Vec4> other = strand_light(hair, swapped);
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(glm::distance(one[i], other[i]) <= 1e-3f * glm::length(one[i]) + 1e-6f);
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "hair lobes: black strands reflect only at their surface" * technique("hair.shading")) {
    std::vector<Vec4> inputs;
    for (int i = 0; i < 100; ++i) {
        const auto x = static_cast<float>(i);
        inputs.emplace_back(1.5f * std::sin(x), 0.3f * x, 1.5f * std::cos(2 * x), 0);
    }
    const std::vector<Vec4> black = strand_light(hair_of(Vec3(0), 0.3f, 0.3f, 0.5f), inputs);
    const std::vector<Vec4> white = strand_light(hair_of(Vec3(1), 0.3f, 0.3f, 0.5f), inputs);
    float inside = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        CHECK(black[i].w == white[i].w);
        CHECK(glm::length(Vec3(black[i])) < 1e-3f);
        inside = std::max(inside, white[i].x);
    }
    CHECK(inside > 0.1f);
}

TEST_CASE_FIXTURE(
    RenderTest, "hair lobes: they match a fiber integrated over its width, within a fifth"
                    * technique("hair.shading")) {
    for (const Vec3& color : {Vec3(1), Vec3(0.6f, 0.3f, 0.1f), Vec3(0.05f, 0.03f, 0.02f)}) {
        for (const float across : {0.2f, 0.3f, 0.6f}) {
            const Material hair = hair_of(color, 0.3f, across, 0, radians(3.0f));
            std::vector<Vec4> inputs;
            for (int i = 0; i < 1000; ++i) {
                const auto x = static_cast<float>(i);
                inputs.emplace_back(
                    1.4f * std::sin(1.7f * x), std::fmod(0.61803f * x, 1.0f) * 2 * kPi,
                    0.8f * std::sin(2.3f * x), 0);
            }
            const std::vector<Vec4> found = strand_light(hair, inputs);
            const oracle::HairFiber fiber = {
                DVec3(color), static_cast<double>(hair.roughness), static_cast<double>(across),
                static_cast<double>(hair.scale_tilt)};
            double off = 0;
            double total = 0;
            for (std::size_t i = 0; i < inputs.size(); ++i) {
                const Vec4& in = inputs[i];
                const auto paths = oracle::fiber_light(
                    fiber, static_cast<double>(in.x), static_cast<double>(in.z),
                    static_cast<double>(in.y));
                for (int c = 0; c < 3; ++c) {
                    const double exact = paths[0][c] + paths[1][c] + paths[2][c] + paths[3][c];
                    const double area = std::cos(static_cast<double>(in.x));
                    off += area * std::abs(static_cast<double>(found[i][c] + found[i].w) - exact);
                    total += area * exact;
                }
            }
            CAPTURE(color.x);
            CAPTURE(across);
            CHECK(off < 0.2 * total);
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "hair lobes: light through a strand of a dense body has passed two more"
                    * technique("hair.shading")) {
    constexpr Vec3 kBrown = {0.12f, 0.06f, 0.03f};
    for (const float to_viewer : {0.0f, 0.7f}) {
        const Vec3 white = transmitted_fraction(hair_of(Vec3(1), 0.3f, 0.3f, 0), to_viewer);
        const Vec3 one = transmitted_fraction(hair_of(kBrown, 0.3f, 0.3f, 0), to_viewer);
        const Vec3 passed = one / white;
        for (const float density : {0.25f, 0.75f}) {
            const Vec3 dense =
                transmitted_fraction(hair_of(kBrown, 0.3f, 0.3f, density), to_viewer);
            const Vec3 through = (1 - density) * one * ((1 - density) + density * passed * passed);
            CHECK(glm::distance(dense, through) < 1e-4f);
            CHECK(dense.z < 0.7f * dense.x);
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "gbuffer: hair stores the direction of its strands, and emits nothing") {
    std::vector<Vec4> inputs = {{0, 0, 0, 0}};
    for (int i = 0; i < 50; ++i) {
        const auto x = static_cast<float>(i);
        inputs.emplace_back(direction(1.5f * std::sin(x), x), 0);
    }
    const std::vector<Vec4> found = evaluate_shader(
        "#define STRANDS\n#include \"lib/gbuffer.glsl\"\n",
        "SurfaceSample s; s.normal_ws = vec3(0.0, 0.0, 1.0); s.albedo = vec3(0.5);"
        "s.emission = vec3(1.0, 2.0, 3.0); s.occlusion = s.roughness = s.metalness = 0.5;"
        "s.material = 0u; s.model = kModelHair; s.strand_ws = x.xyz;"
        "s = unpack_surface(pack_surface(s)); y = vec4(s.strand_ws, s.emission.x);",
        inputs);
    CHECK(found[0] == Vec4(0));
    for (std::size_t i = 1; i < inputs.size(); ++i) {
        CHECK(glm::distance(found[i], inputs[i]) < 2e-4f);
    }
}

TEST_CASE(
    "hair: strands run along v, and white highlights lie toward their roots"
    * technique("hair.shading")) {
    const Material black = hair_of(Vec3(0), 0.15f, 0.3f, 0, radians(4.0f));
    const MeshData square = make_square();
    // v runs down: so do strands, and inclinations to the tip are below the horizon.
    const auto lit = [&](float inclination, float azimuth, const MeshData& mesh) {
        const Vec3 d = direction(inclination, azimuth);
        return lit_square(black, {d.y, -d.x, d.z}, mesh).x;
    };
    const float tilt = radians(8.0f);
    CHECK(lit(-tilt, 0, square) > 1.5f * lit(tilt, 0, square));
    CHECK(lit(-tilt, 0, square) > lit(0, 0, square));
    // Across strands, a highlight is wide.
    CHECK(lit(-tilt, 1, square) > 0.7f * lit(-tilt, 0, square));
    CHECK(lit(-1, 0, square) < 0.1f * lit(-tilt, 0, square));
    MeshData turned = square;
    turned.tangents.assign(4, {0, 1, 0, 1});  // strands along +x
    CHECK(lit(-tilt, 0, turned) == test::near(lit(tilt, 0, turned)).epsilon(1e-3));
    turned.tangents.clear();
    CHECK(std::isfinite(lit(0.3f, 0, turned)));
}

TEST_CASE(
    "hair: a lit square has the light of the strands that are not occluded by others"
    * technique("hair.shading")) {
    constexpr float kDensity = 0.6f;
    const Material hair = hair_of({0.6f, 0.3f, 0.1f}, 0.3f, 0.3f, kDensity, radians(3.0f));
    for (const Vec2& a : {Vec2(0, 0), Vec2(0.4f, 0.7f), Vec2(0.1f, 1.4f), Vec2(-0.3f, 2.6f)}) {
        const Vec3 d = direction(a.x, a.y);
        const double lit =
            1 - static_cast<double>(kDensity) * (1 - reached(static_cast<double>(d.z)));
        const Vec4 light = strand_light(hair, {{a.x, a.y, 0, 0}}, lit)[0];
        const Vec3 found = lit_square(hair, {d.y, -d.x, d.z}, make_square());
        CHECK(glm::distance(found, Vec3(light) + light.w) < 0.01f * glm::length(found));
    }
}

TEST_CASE(
    "hair: strands of a dense body cast no shadow on each other, distant casters do"
    * technique("hair.shading")) {
    const auto lit = [](float density, float distance, bool shadowed) {
        Scene scene;
        scene.place(
            scene.add(make_square()), scene.add(hair_of({0.6f, 0.3f, 0.1f}, 0.3f, 0.3f, density)),
            at({0, 0, 0}));
        scene.place(
            scene.add(make_square()), scene.add(Material{}), at({1.2f + distance, 0, distance}));
        const Vec3 behind_edge = {0.2f + 0.6f * distance, 0, 0};  // visible past the caster's edge
        const Entity light =
            scene.shine(DirectionalLight{.illuminance = 3}, look_at({0, 0, 0}, {-1, 0, -1}));
        if (shadowed) {
            scene.world.add(
                light, Shadow{
                           .filter = ShadowFilter::Hard,
                           .resolution = 2048,
                           .cascades = 1,
                           .distance = 3});
        }
        return scene.radiance(scene.look({-0.3f, 0, 1}, behind_edge, 65, 65)).at(32, 32, 1);
    };
    for (const float distance : {0.015f, 0.03f, 0.3f}) {
        CAPTURE(distance);
        const double depth = std::sqrt(2.0) * static_cast<double>(distance) / 0.03;
        const double visible = std::exp(-depth * depth);
        const auto open = static_cast<double>(lit(0.6f, distance, false));
        const auto shaded = static_cast<double>(lit(0.6f, distance, true));
        CHECK(std::abs(shaded - visible * open) < 0.01 * open);
        CHECK(lit(0, distance, true) == 0);
    }
}

TEST_CASE("hair: white hair in white light is white") {
    for (const float scatter : {0.0f, 1.0f}) {
        for (const Vec3& eye : {Vec3(0, 0, 1), Vec3(0.3f, 1, 0.5f)}) {
            Scene scene;
            scene.place(
                scene.add(make_square()), scene.add(hair_of(Vec3(1), 0.3f, 0.3f, scatter)),
                at({0, 0, 0}));
            scene.world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = Vec3(1)});
            const float found = scene.radiance(scene.look(eye, {0, 0, 0}, 17, 17)).at(8, 8, 1);
            CHECK(found <= 1.002f);
            CHECK(found > 0.98f);
        }
    }
}

}  // namespace limn::test::hair_test
