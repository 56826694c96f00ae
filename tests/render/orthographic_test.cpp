#include "ecs/components/shadow.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"

#include <cmath>
#include <vector>

namespace limn::test::orthographic_test {
namespace {

constexpr int kSize = 64;

Material flat_white() {
    return {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
}

/// Diffuse only, so that it is as bright from every side.
Material chalk() {
    return {.shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}};
}

RenderView orthographic(const Affine& pose, const Affine& previous, float height) {
    return make_render_view(
        {.ortho_height = height, .near = 0.05f}, pose, previous, {.width = kSize, .height = kSize});
}

RenderView orthographic(const Affine& pose, float height) {
    return orthographic(pose, pose, height);
}

int white_in_row(const gpu::FloatImage& image, int row) {
    int count = 0;
    for (int x = 0; x < image.width; ++x) {
        count += image.at(x, row, 0) > 0.5f ? 1 : 0;
    }
    return count;
}

Vec2 pixel_of(const Mat4& clip_from_world, const Vec3& position) {
    const Vec4 clip = clip_from_world * Vec4(position, 1);
    return 0.5f * kSize * (Vec2(clip) / clip.w + 1.0f);
}

}  // namespace

TEST_CASE_FIXTURE(Scene, "orthographic: a square is as large and as bright at every distance") {
    const MeshId square = add(make_square());
    const MaterialId white = add(flat_white());
    const RenderView view = orthographic(at({0, 0, 20}), 4);
    for (const float z : {0.0f, 10.0f, 19.0f}) {
        CAPTURE(z);
        const Entity entity =
            place(square, white, affine_from({0.03f, 0.02f, z}, {1, 0, 0, 0}, Vec3(0.5f)));
        const gpu::FloatImage image = radiance(view);
        int covered = 0;
        for (int y = 0; y < kSize; ++y) {
            covered += white_in_row(image, y);
        }
        CHECK(covered == 256);  // 1 m of 4 in 64 pixels is 16
        CHECK(image.at(32, 32, 0) == near(1).epsilon(1e-3));
        world.destroy(entity);
    }
    // Nothing nearer than the near plane, though the eye is far behind it.
    place(square, white, at({0, 0, 19.96f}));
    CHECK(largest_difference(radiance(view), radiance(orthographic(at({0, 0, -1}), 4))) == 0);
}

TEST_CASE_FIXTURE(Scene, "orthographic: parallel edges stay parallel") {
    // A floor of 1 x 20 m, viewed from above at an angle.
    place(
        add(make_square()), add(flat_white()),
        affine_from(
            {0, 0, -10}, glm::angleAxis(radians(-90.0f), Vec3(1, 0, 0)), Vec3(0.5f, 10, 1)));
    const gpu::FloatImage image = radiance(orthographic(look_at({0, 6, 2}, {0, 0, -8}), 4));
    for (const int row : {2, 20, 44, 61}) {
        CAPTURE(row);
        CHECK(white_in_row(image, row) == 16);
    }
}

TEST_CASE_FIXTURE(Scene, "orthographic: light and shadow on a floor match perspective") {
    const MeshId square = add(make_square());
    const MaterialId white = add(chalk());
    place(square, white, affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(3)));
    // Behind both cameras, which see none of it but its shadow.
    place(square, white, affine_from({1.5f, 0.3f, 3}, {1, 0, 0, 0}, Vec3(0.6f)));
    const Affine sun = look_at({1, 0.2f, 2}, {0, 0, 0});
    const Entity lamp = world.create(
        DirectionalLight{.illuminance = 3}, Shadow{.distance = 20}, WorldTransform{sun});
    world.create(PointLight{.intensity = 0.4f}, WorldTransform{at({-0.4f, 0.5f, 0.4f})});
    // From 1 m, 90 degrees show the same 2 m of the floor, to the pixel.
    const gpu::FloatImage want = radiance(look({0, 0, 1}, {0, 0, 0}, kSize, kSize));
    const gpu::FloatImage got = radiance(orthographic(at({0, 0, 1}), 2));
    int different = 0;
    int dark = 0;
    float darkest = 1e9f;
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const float a = want.at(x, y, 0);
            different += std::abs(got.at(x, y, 0) - a) > 0.03f * a ? 1 : 0;
            darkest = std::min(darkest, a);
        }
    }
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            dark += want.at(x, y, 0) < 0.5f * want.at(8, 8, 0) ? 1 : 0;
        }
    }
    CHECK(dark > 100);
    CHECK(different < 120);  // the edge of the shadow, from maps of other texels
    world.destroy(lamp);
}

TEST_CASE("orthographic: under a moving camera everything moves by the same number of pixels") {
    const RenderView view = orthographic(at({0.1f, 0, 5}), at({0, 0, 5}), 4);
    for (const float z : {4.0f, 0.0f, -5.0f}) {
        const Vec3 position = {0.3f, -0.7f, z};
        const Vec2 moved = pixel_of(view.unjittered_from_world, position)
                           - pixel_of(view.previous_clip_from_world, position);
        CHECK(moved.x == near(-1.6).epsilon(0.005));  // 0.1 m of 4 in 64 pixels
        CHECK(std::abs(moved.y) < 0.005f);
    }
}

}  // namespace limn::test::orthographic_test
