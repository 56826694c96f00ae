// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/ink.h"
#include "ecs/components/shadow.h"
#include "tests/near.h"

#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace limn::test::toon_outline_test {
namespace {

constexpr int kPixels = 256;
constexpr float kHeight = 3;  // of the view [m]
constexpr double kPixelArea = static_cast<double>(kHeight) * kHeight / (kPixels * kPixels);

struct Pixels {
    int ink = 0;
    int white = 0;
};

/// A white ball of radius 1 whose outline is red.
struct OutlineScene : Scene {
    MeshId ball = add(make_ball(96));
    MaterialId white = add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}});
    MaterialId ink = add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 0, 0, 1}});

    Entity outlined(float width, const Affine& pose = at({0, 0, 0})) {
        const Entity entity = place(ball, white, pose);
        world.add(entity, ToonOutline{width, ink});
        return entity;
    }
    gpu::FloatImage flat_view() {
        return radiance(make_render_view(
            {.ortho_height = kHeight, .near = 0.05f}, at({0, 0, 5}), at({0, 0, 5}),
            {.width = kPixels, .height = kPixels}));
    }
    static bool is_ink(const gpu::FloatImage& image, int x, int y) {
        return image.at(x, y, 0) > 0.5f && image.at(x, y, 1) < 0.5f;
    }
    /// Pixels within a distance of the center [m].
    static Pixels count(const gpu::FloatImage& image, double radius = 10) {
        Pixels all;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const double scale = static_cast<double>(kHeight) / kPixels;
                const double dx = (x + 0.5 - 0.5 * kPixels) * scale;
                const double dy = (y + 0.5 - 0.5 * kPixels) * scale;
                if (dx * dx + dy * dy < radius * radius) {
                    all.ink += is_ink(image, x, y) ? 1 : 0;
                    all.white += image.at(x, y, 1) > 0.5f ? 1 : 0;
                }
            }
        }
        return all;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    OutlineScene, "toon outline: a ball has a ring as wide as the line, and none inside"
                      * technique("tex.toon-outline")) {
    for (const float f : {0.05f, 0.2f, 0.4f}) {
        CAPTURE(f);
        const Entity entity = outlined(f);
        const gpu::FloatImage image = flat_view();
        const double r = 1 + static_cast<double>(f);
        const double ring = static_cast<double>(kPi) * (r * r - 1);
        CHECK(count(image).ink * kPixelArea == near(ring).epsilon(0.02));
        CHECK(count(image).white * kPixelArea == near(static_cast<double>(kPi)).epsilon(0.01));
        CHECK(count(image, 0.985).ink == 0);
        world.destroy(entity);
    }
}

TEST_CASE_FIXTURE(
    OutlineScene,
    "toon outline: of width 0, nothing is seen of it" * technique("tex.toon-outline")) {
    outlined(0);
    CHECK(count(flat_view()).ink <= 8);
}

TEST_CASE_FIXTURE(
    OutlineScene, "toon outline: front faces of the inflated mesh would hide all of it"
                      * technique("tex.toon-outline")) {
    place(ball, white, at({0, 0, 0}));
    const Entity hull = place(ball, ink, at({0, 0, 0}));
    world.add(hull, Inflate{0.2f});
    const Pixels pixels = count(flat_view());
    CHECK(pixels.white == 0);
    CHECK(pixels.ink * kPixelArea == near(static_cast<double>(kPi) * 1.44).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    OutlineScene, "toon outline: a mirrored mesh and an inflated one have theirs"
                      * technique("tex.toon-outline")) {
    const Entity plain = outlined(0.2f);
    const gpu::FloatImage image = flat_view();
    world.destroy(plain);
    const Entity mirrored = outlined(0.2f, affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(-1, 1, 1)));
    CHECK(std::abs(count(flat_view()).ink - count(image).ink) <= 12);
    world.destroy(mirrored);
    const Entity inflated = outlined(0.1f);
    world.add(inflated, Inflate{0.1f});
    const Pixels thick = count(flat_view());
    CHECK(thick.white * kPixelArea == near(static_cast<double>(kPi) * 1.21).epsilon(0.01));
    CHECK(thick.ink * kPixelArea == near(static_cast<double>(kPi) * (1.44 - 1.21)).epsilon(0.02));
}

TEST_CASE_FIXTURE(OutlineScene, "toon outline: it casts no shadow") {
    const MaterialId paper = add(Material{
        .shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}});
    place(add(make_square()), paper, affine_from({0, 0, -1.2f}, {1, 0, 0, 0}, Vec3(4)));
    const Entity sun = shine(
        DirectionalLight{.illuminance = kPi},
        affine_from({0, 0, 0}, glm::angleAxis(radians(50.0f), Vec3(0, 1, 0)), Vec3(1)));
    world.add(sun, Shadow{.resolution = 512, .distance = 10});
    const Entity entity = outlined(0.3f);
    const RenderView view = look({0, 0, 7}, {0, 0, 0}, 128, 128);
    const gpu::FloatImage with = radiance(view);
    world.remove<ToonOutline>(entity);
    const gpu::FloatImage without = radiance(view);
    int ink_pixels = 0;
    int changed = 0;
    for (int y = 0; y < with.height; ++y) {
        for (int x = 0; x < with.width; ++x) {
            ink_pixels += is_ink(with, x, y) ? 1 : 0;
            changed += !is_ink(with, x, y) && rgb_at(with, x, y) != rgb_at(without, x, y) ? 1 : 0;
        }
    }
    CHECK(ink_pixels > 100);
    CHECK(changed == 0);
}

}  // namespace limn::test::toon_outline_test
