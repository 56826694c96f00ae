#include "bench/oracles/light_oracle.h"
#include "ecs/components/rendering.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <array>
#include <vector>

namespace limn::test::skin_shade_test {
namespace {

/// A ball of skin, lit from somewhere.
class Face : public Scene {
  public:
    Material skin = {
        .shading = ShadingModel::Skin,
        .base_color = {0.8f, 0.5f, 0.4f, 1},
        .specular = {0.2f, 0.2f, 0.2f},
        .shininess = 20};

    void show(const Vec3& light) {
        place(add(make_ball()), add(skin), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.8f)));
        shine(PointLight{.color = {1, 1, 1}, .intensity = 4, .radius = 0}, at(light));
    }
    [[nodiscard]] RenderView full_view() const { return look({0, 0, 2}, {0, 0, 0}, 65, 65); }
};

float green(const gpu::FloatImage& image, int x, int y) {
    return image.at(x, y, 1);
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "skin shade: the rim has the values of both printed forms" * technique("char.skin-shade")) {
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/reflector.glsl\"\n",
        "y.x = skin_rim(x.x, true); y.y = skin_rim(x.x, false);",
        {Vec4(0), Vec4(0.25f), Vec4(0.5f), Vec4(0.75f), Vec4(1), Vec4(-0.5f), Vec4(1.5f)});
    const float wide[] = {1, 0.9375f, 0.75f, 0.4375f, 0, 1, 0};
    const float narrow[] = {1, 0.5625f, 0.25f, 0.0625f, 0, 1, 0};
    for (std::size_t i = 0; i < found.size(); ++i) {
        CHECK(found[i].x == wide[i]);
        CHECK(found[i].y == narrow[i]);
    }
}

TEST_CASE("skin shade: with a black rim it is Blinn, to the bit" * technique("char.skin-shade")) {
    const auto picture = [](ShadingModel model) {
        Face face;
        face.skin.shading = model;
        face.skin.skin_color = {0, 0, 0};
        face.show({1, 1, 2});
        return face.radiance(face.full_view());
    };
    const gpu::FloatImage skin = picture(ShadingModel::Skin);
    CHECK(skin.pixels == picture(ShadingModel::Blinn).pixels);
    CHECK(green(skin, 32, 32) > 0.1f);
}

TEST_CASE(
    "skin shade: lit from behind, nothing but the rim is bright, and the wide one is wider"
    * technique("char.skin-shade")) {
    gpu::FloatImage rims[2];
    for (const bool wide : {false, true}) {
        Face face;
        face.skin.wide_rim = wide;
        face.show({0, 0, -2});
        gpu::FloatImage& image = rims[wide ? 1 : 0];
        image = face.radiance(face.full_view());
        CHECK(green(image, 32, 32) < 1e-3f);  // head on
        float before = 0;
        for (int x = 33; x < 46; ++x) {  // outward
            CHECK(green(image, x, 32) >= before);
            before = green(image, x, 32);
        }
        CHECK(before > 0.005f);
    }
    for (int x = 34; x < 46; ++x) {
        CHECK(green(rims[1], x, 32) > green(rims[0], x, 32));
    }
}

TEST_CASE(
    "skin shade: each point of a ball is as the oracle says, by any light method"
    * technique("char.skin-shade")) {
    for (const bool wide : {false, true}) {
        Face face;
        face.skin.wide_rim = wide;
        face.show({1.5f, 0.5f, 0.4f});
        for (const LightMethod method :
             {LightMethod::Clustered, LightMethod::ObjectMajor, LightMethod::LightMajor}) {
            face.world.insert_resource(Rendering{.lights = method});
            const gpu::FloatImage image = face.radiance(face.full_view());
            const gpu::FloatImage depth = face.aov(face.full_view(), "depth");
            const gpu::FloatImage normal = face.aov(face.full_view(), "normal");
            int compared = 0;
            for (int y = 0; y < 65; ++y) {
                for (int x = 0; x < 65; ++x) {
                    const double z = static_cast<double>(depth.at(x, y, 0));
                    if (z > 10) {
                        continue;
                    }
                    using oracle::DVec3;
                    const DVec3 point = {
                        ((x + 0.5) / 32.5 - 1) * z, -((y + 0.5) / 32.5 - 1) * z, 2 - z};
                    const DVec3 n = glm::normalize(DVec3(rgb_at(normal, x, y)));
                    const std::array<oracle::Arriving, 1> lights = {oracle::arrive(
                        PointLight{.color = {1, 1, 1}, .intensity = 4, .radius = 0},
                        DVec3(1.5, 0.5, 0.4f), point, n)};
                    const DVec3 exact = oracle::skin(
                        {.ambient = DVec3(0),
                         .diffuse = DVec3(face.skin.base_color),
                         .specular = DVec3(face.skin.specular),
                         .shininess = 20},
                        DVec3(face.skin.skin_color), wide, lights, n,
                        glm::normalize(DVec3(0, 0, 2) - point));
                    CHECK(glm::distance(DVec3(rgb_at(image, x, y)), exact) < 6e-3 * exact.x + 1e-3);
                    ++compared;
                }
            }
            CHECK(compared > 500);
        }
    }
}

}  // namespace limn::test::skin_shade_test
