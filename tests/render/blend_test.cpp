#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

namespace limn::test::blend_test {
namespace {

/// A pane that gives off `color` and hides `opacity` of what is behind it.
Material pane(const Vec3& color, float opacity) {
    return {
        .shading = ShadingModel::Unlit,
        .alpha_mode = AlphaMode::Blend,
        .base_color = Vec4(color, opacity)};
}

struct PaneScene : Scene {
    [[nodiscard]] RenderView view() const { return look({0, 0, 1}, {0, 0, 0}, 9, 9); }
    Vec3 center_color() { return rgb_at(radiance(view()), 4, 4); }
};

}  // namespace

TEST_CASE_FIXTURE(
    PaneScene, "blend: panes are blended back to front, in any order of creation"
                   * technique("engine.batching")) {
    const MeshId square = add(make_square());
    const MaterialId wall =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}});
    const MaterialId red = add(pane({1, 0, 0}, 0.5f));
    const MaterialId green = add(pane({0, 1, 0}, 0.25f));
    const MaterialId blue = add(pane({0, 0, 1}, 0.5f));
    Vec3 want = Vec3(1);
    want = 0.5f * want + 0.5f * Vec3(1, 0, 0);
    want = 0.75f * want + 0.25f * Vec3(0, 1, 0);
    want = 0.5f * want + 0.5f * Vec3(0, 0, 1);
    const std::vector<std::pair<MaterialId, float>> layers = {
        {wall, -1.0f}, {red, -0.6f}, {green, -0.3f}, {blue, 0.0f}};
    for (const std::vector<int>& order : {std::vector{0, 1, 2, 3}, {3, 2, 1, 0}, {2, 0, 3, 1}}) {
        world.clear();
        for (const int i : order) {
            place(
                square, layers[i].first,
                affine_from({0, 0, layers[i].second}, {1, 0, 0, 0}, Vec3(3)));
        }
        const Vec3 got = center_color();
        for (int c = 0; c < 3; ++c) {
            CHECK(got[c] == test::near(want[c]).epsilon(2e-3));
        }
    }
}

TEST_CASE_FIXTURE(
    PaneScene, "blend: opaque surfaces hide panes behind them, and panes write no depth") {
    const MeshId square = add(make_square());
    place(
        square, add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        at({0, 0, 0}));
    place(square, add(pane({1, 0, 0}, 0.5f)), at({0, 0, -0.5f}));
    CHECK(center_color() == Vec3(1));
    world.clear();
    place(square, {1}, at({0, 0, 0}));
    CHECK(aov(view(), "depth").at(4, 4, 0) == kNoDepth);
    CHECK(center_color().x == test::near(0.5f).epsilon(1e-3));
}

TEST_CASE_FIXTURE(PaneScene, "blend: clear glass still reflects, most at grazing angles") {
    world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}, .visible = false});
    Material glass = {.alpha_mode = AlphaMode::Blend, .base_color = {1, 1, 1, 0}, .roughness = 0};
    place(add(make_ball(64)), add(glass), at({0, 0, -1.2f}));
    const gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, 128, 128));
    CHECK(image.at(64, 64, 0) == test::near(0.04f).epsilon(0.05));
    float rim = 0;
    for (int x = 0; x < 128; ++x) {
        rim = std::max(rim, image.at(x, 64, 0));
    }
    CHECK(rim > 0.4f);
    // Reflection replaces the background: in a furnace the pane is invisible.
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}});
    for (const float value : radiance(look({0, 0, 1}, {0, 0, 0}, 32, 32)).pixels) {
        CHECK(value == test::near(1).epsilon(0.02));
    }
}

TEST_CASE_FIXTURE(PaneScene, "blend: an opaque blended pane is lit as an opaque one") {
    const MeshId square = add(make_square());
    const Vec4 color = {0.7f, 0.5f, 0.2f, 1};
    shine(PointLight{.intensity = 3}, at({0.3f, 0.2f, 0.7f}));
    shine(SpotLight{}, look_at({0, 0, 1}, {0.2f, 0, 0}));
    place(square, add(Material{.base_color = color, .roughness = 0.4f}), at({0, 0, 0}));
    const gpu::FloatImage opaque = radiance(view());
    world.query<MeshInstance>().each([&](MeshInstance& instance) {
        instance.material =
            add(Material{.alpha_mode = AlphaMode::Blend, .base_color = color, .roughness = 0.4f});
    });
    const gpu::FloatImage blended = radiance(view());
    for (std::size_t i = 0; i < opaque.pixels.size(); ++i) {
        CHECK(blended.pixels[i] == test::near(opaque.pixels[i]).epsilon(5e-3));
    }
}

}  // namespace limn::test::blend_test
