#include "content/make/models/shapes.h"
#include "ecs/components/curvature_view.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <cmath>
#include <utility>

namespace limn::test::curvature_view_test {
namespace {

struct CurvatureScene : Scene {
    gpu::FloatImage
    colors(MeshData mesh, const Vec3& eye, CurvatureAxis axis, float full, int size = 64) {
        world.clear();
        world.insert_resource(Assets{});
        world.insert_resource(CurvatureView{.axis = axis, .full = full});
        place(add(std::move(mesh)), add(Material{.base_color = {0, 0, 0, 1}}), at({0, 0, 0}));
        return radiance(look(eye, {0, 0, 0}, size, size));
    }
};

constexpr CurvatureAxis kAxes[] = {CurvatureAxis::Tangent, CurvatureAxis::Bitangent};

void check_color(const gpu::FloatImage& image, int x, int y, const Vec3& expected) {
    const Vec3 found = rgb_at(image, x, y);
    CAPTURE(x);
    CAPTURE(y);
    CHECK(found.x == near(double(expected.x)).scale(1).epsilon(0.03));
    CHECK(found.y == near(double(expected.y)).scale(1).epsilon(0.03));
    CHECK(found.z == near(double(expected.z)).scale(1).epsilon(0.03));
}

}  // namespace

TEST_CASE_FIXTURE(
    CurvatureScene, "curvature view: a plane is green" * technique("relief.curvature-view")) {
    for (const CurvatureAxis axis : kAxes) {
        const gpu::FloatImage image = colors(make_square(), {0, 0, 1}, axis, 0.001f);
        check_color(image, 32, 32, {0, 1, 0});
        check_color(image, 5, 60, {0, 1, 0});
    }
}

TEST_CASE_FIXTURE(
    CurvatureScene, "curvature view: a ball is equally red along both directions"
                        * technique("relief.curvature-view")) {
    // Radius 1/2: 1 / (2 R) = 1.
    for (const CurvatureAxis axis : kAxes) {
        const gpu::FloatImage full = colors(make_sphere({}), {0, 0, 1.2f}, axis, 1);
        const gpu::FloatImage half = colors(make_sphere({}), {0, 0, 1.2f}, axis, 2);
        for (const int x : {20, 32, 44}) {
            check_color(full, x, 32, {1, 0, 0});
            check_color(half, x, 26, {0.5f, 0.5f, 0});
        }
    }
    // From within, its back faces are not drawn.
    const gpu::FloatImage inside = colors(make_sphere({}), {0, 0, 0.1f}, kAxes[0], 1);
    check_color(inside, 32, 32, {0, 0, 0});
}

TEST_CASE_FIXTURE(
    CurvatureScene,
    "curvature view: around a torus it is convex outside, flat on top and concave inside, along "
    "its tube the same"
        * technique("relief.curvature-view")) {
    // Radii 0.35 and 0.15. Around the axis: cos(phi) / (2 (R + r cos(phi))), on the outer equator
    // 1 / (2 * 0.5) = 1, on the inner one -1 / (2 * 0.2) = -2.5; around the tube 1 / (2 r) = 3.33.
    const TorusShape shape = {.segments = 192, .sides = 96};
    const Vec3 above = {0, 1, 0.0001f};
    const gpu::FloatImage around = colors(make_torus(shape), above, kAxes[0], 1, 512);
    // The image is 2 m wide at a distance of 1 m: rings at a height of 0.15 appear larger.
    const auto column = [](double radius, double height) {
        return static_cast<int>(256 + 256 * radius / (1 - height));
    };
    check_color(around, column(0.35, 0.15), 256, {0, 1, 0});
    const Vec3 outside = rgb_at(around, column(0.35 + 0.15 * 0.6, 0.15 * 0.8), 256);
    CHECK(outside.x == near(0.6 / (2 * 0.44)).epsilon(0.05));
    CHECK(outside.z == 0);
    const Vec3 inside = rgb_at(around, column(0.35 - 0.15 * 0.6, 0.15 * 0.8), 256);
    CHECK(inside.x == 0);
    CHECK(inside.z == near(1).epsilon(0.2));
    const gpu::FloatImage tube = colors(make_torus(shape), above, kAxes[1], 1 / 0.3f, 512);
    for (const double cosine : {-0.6, 0.0, 0.6}) {
        const double sine = std::sqrt(1 - cosine * cosine);
        check_color(tube, column(0.35 + 0.15 * cosine, 0.15 * sine), 256, {1, 0, 0});
    }
}

}  // namespace limn::test::curvature_view_test
