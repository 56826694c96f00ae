#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

// The shading model Strand, against Banks' formulas in double precision.

namespace limn::test::strand_test {
namespace {

using DVec3 = glm::dvec3;

struct StrandLight {
    double diffuse;
    double mirrored;
};

/// By the normal in the plane of strand and light, and the direction mirrored about it.
StrandLight by_normal(const DVec3& t, const DVec3& l, const DVec3& v) {
    const DVec3 n = glm::normalize(l - t * glm::dot(l, t));
    const DVec3 r = 2.0 * glm::dot(n, l) * n - l;
    return {glm::dot(n, l), glm::dot(r, v)};
}

/// Of the shader, for u = l.t and v = v.t.
std::vector<Vec4> by_shader(const std::vector<Vec4>& uv) {
    return evaluate_shader(
        "#include \"lib/strand.glsl\"\n",
        "y.xy = vec2(strand_diffuse(x.x), strand_mirrored(x.x, x.y));", uv);
}

constexpr float kShininess = 20;
const Vec3 kColor = {0.6f, 0.4f, 0.2f};
const Vec3 kSpecular = {0.3f, 0.2f, 0.5f};

Material thread(float rotation) {
    return {
        .shading = ShadingModel::Strand,
        .base_color = Vec4(kColor, 1),
        .specular = kSpecular,
        .shininess = kShininess,
        .anisotropy_rotation = rotation};
}

/// The square of side 2 in z = 0, made of threads, under parallel light.
gpu::FloatImage lit_threads(
    const Material& material, const Vec3& to_light, const ImageData* map = nullptr, int size = 32) {
    Scene scene;
    Material used = material;
    if (map != nullptr) {
        used.anisotropy_texture.image = scene.add(*map);
    }
    scene.place(scene.add(make_square()), scene.add(used), at({0, 0, 0}));
    scene.shine(DirectionalLight{.illuminance = kPi}, look_at(to_light, {0, 0, 0}));
    return scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, size, size));
}

/// One texel of a direction along tangent and bitangent.
ImageData direction_map(const Vec2& d) {
    ImageData image{
        .name = "directions",
        .width = 1,
        .height = 1,
        .format = PixelFormat::Rgba32F,
        .pixels = {}};
    const float texel[4] = {0.5f + 0.5f * d.x, 0.5f + 0.5f * d.y, 1, 1};
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(texel);
    image.pixels.assign(bytes, bytes + sizeof texel);
    return image;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "strand: light along, across and beside the threads has the values of the formula"
                    * technique("shade.strand-banks")) {
    const std::vector<Vec4> uv = {{0, 0, 0, 0},        {1, 0, 0, 0},       {0.5f, -0.5f, 0, 0},
                                  {0.5f, 0.5f, 0, 0},  {0.6f, 0.8f, 0, 0}, {0.6f, -0.6f, 0, 0},
                                  {1.000001f, 0, 0, 0}};
    const std::vector<Vec4> got = by_shader(uv);
    CHECK(got[0].x == near(1));
    CHECK(got[0].y == near(1));
    CHECK(got[1].x == near(0).scale(1));
    CHECK(got[1].y == near(0).scale(1));
    CHECK(got[2].x == near(0.8660254).epsilon(1e-6));
    CHECK(got[2].y == near(1).epsilon(1e-6));
    CHECK(got[3].y == near(0.5).epsilon(1e-6));
    CHECK(got[4].y == near(0).scale(1).epsilon(1e-6));
    CHECK(got[6].x == 0);  // not the root of a negative number
    const auto total = [](const Vec4& light) {
        return 0.1 + 0.6 * static_cast<double>(light.x)
               + 0.3 * std::pow(static_cast<double>(light.y), 20.0);
    };
    CHECK(total(got[2]) == near(0.919615).epsilon(1e-5));
    CHECK(total(got[5]) == near(0.88).epsilon(1e-5));
}

TEST_CASE_FIXTURE(
    RenderTest, "strand: highlights are those of the nearest normal, at most brighter"
                    * technique("shade.strand-banks")) {
    const DVec3 t(1, 0, 0);
    const DVec3 l = DVec3(0.3, 0, 1) / std::sqrt(1.09);
    const double exact[] = {1, 0.877088, 0.541284, 0.082569, -0.834862};
    const double degrees[] = {0, 30, 60, 90, 180};
    for (std::size_t i = 0; i < std::size(exact); ++i) {
        const double a = glm::radians(degrees[i]);
        const DVec3 v = DVec3(-0.3, std::sin(a), std::cos(a)) / std::sqrt(1.09);
        const StrandLight expected = by_normal(t, l, v);
        CHECK(expected.mirrored == near(exact[i]).epsilon(1e-5));
        const Vec4 got = by_shader(
            {{static_cast<float>(glm::dot(l, t)), static_cast<float>(glm::dot(v, t)), 0, 0}})[0];
        CHECK(static_cast<double>(got.x) == near(expected.diffuse).epsilon(1e-6));
        CHECK(got.y == near(1).epsilon(1e-6));
        CHECK(static_cast<double>(got.y) >= expected.mirrored - 1e-6);
    }
}

TEST_CASE(
    "strand: a lit surface has the formula's radiance, less what its threads shadow"
    * technique("shade.strand-banks")) {
    for (const Vec3& toward : {Vec3(0.5f, 0.2f, 1), Vec3(-0.4f, 0.9f, 0.6f), Vec3(0, 0, 1)}) {
        const DVec3 l = glm::normalize(DVec3(toward));
        const gpu::FloatImage image = lit_threads(thread(0), toward);
        for (const IVec2 p : {IVec2(2, 3), IVec2(16, 16), IVec2(29, 7), IVec2(10, 28)}) {
            const DVec3 point((p.x + 0.5) / 16 - 1, 1 - (p.y + 0.5) / 16, 0);
            const DVec3 v = glm::normalize(DVec3(0, 0, 1) - point);
            const double lt = l.x;
            const double vt = v.x;
            const double diffuse = std::sqrt(1 - lt * lt);
            const double mirrored = std::max(0.0, diffuse * std::sqrt(1 - vt * vt) - lt * vt);
            const double highlight = std::pow(mirrored, static_cast<double>(kShininess));
            for (int c = 0; c < 3; ++c) {
                const double expected = l.z
                                        * (static_cast<double>(kColor[c]) * diffuse
                                           + static_cast<double>(kSpecular[c]) * highlight);
                CHECK(static_cast<double>(image.at(p.x, p.y, c)) == near(expected).epsilon(5e-3));
            }
        }
    }
}

TEST_CASE(
    "strand: threads turned by a right angle turn the highlight"
    * technique("shade.anisotropy-map")) {
    constexpr int kSize = 32;
    const gpu::FloatImage along = lit_threads(thread(0), {0.5f, 0, 1}, nullptr, kSize);
    const ImageData up = direction_map({0, 1});
    for (const bool by_map : {false, true}) {
        const gpu::FloatImage turned = by_map ? lit_threads(thread(0), {0, 0.5f, 1}, &up, kSize)
                                              : lit_threads(thread(0.5f * kPi), {0, 0.5f, 1});
        CAPTURE(by_map);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                // Counter-clockwise: what was at (x, y) from the center is at (-y, x).
                CHECK(turned.at(y, kSize - 1 - x, 1) == near(along.at(x, y, 1)).epsilon(2e-3));
            }
        }
    }
    CHECK(along.at(16, 1, 1) > 0.05f);
}

TEST_CASE(
    "strand: a map of the tangent changes nothing, nor does an opposite direction"
    * technique("shade.anisotropy-map")) {
    const Vec3 toward = {0.4f, 0.3f, 1};
    const gpu::FloatImage plain = lit_threads(thread(0.3f), toward);
    for (const Vec2 direction : {Vec2(1, 0), Vec2(-1, 0), Vec2(0, 0)}) {
        const ImageData map = direction_map(direction);
        CHECK(largest_difference(plain, lit_threads(thread(0.3f), toward, &map)) <= 1e-3f);
    }
    CHECK(largest_difference(plain, lit_threads(thread(0.3f + kPi), toward)) <= 1e-3f);
    const ImageData across = direction_map({0, 1});
    CHECK(largest_difference(plain, lit_threads(thread(0.3f), toward, &across)) > 0.02f);
}

TEST_CASE_FIXTURE(
    Scene,
    "strand: a mesh without tangents is lit, not black or NaN" * technique("shade.strand-banks")) {
    MeshData bare = make_square();
    bare.tangents.clear();
    place(add(bare), add(thread(0)), at({0, 0, 0}));
    shine(DirectionalLight{.illuminance = kPi}, look_at({0.2f, 0, 1}, {0, 0, 0}));
    const gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, 8, 8));
    for (const float value : image.pixels) {
        CHECK(std::isfinite(value));
    }
    CHECK(image.at(4, 4, 0) > 0.1f);
}

}  // namespace limn::test::strand_test
