#include "bench/fakephong/counted.h"
#include "bench/fakephong/forward_difference.h"
#include "bench/fakephong/phong_models.h"
#include "bench/fakephong/phong_raster.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace limn::fakephong::forward_difference_test {
namespace {

using test::near;

/// The thesis's example, 2 x^2 + 3 x y - y^2 + x - 4 y + 5.
std::int64_t printed_quadratic(std::int64_t x, std::int64_t y) {
    return 2 * x * x + 3 * x * y - y * y + x - 4 * y + 5;
}

PhongScene on_screen(PhongScene scene) {
    scene.interpolation = Interpolation::Screen;
    scene.channels = Channels::Full;
    return scene;
}

std::vector<PhongScene> stepped_scenes() {
    return {on_screen(triangle_scene()), on_screen(sphere_scene()), on_screen(teapot_scene())};
}

float largest_difference(const PhongImage& a, const PhongImage& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.color.pixels.size(); ++i) {
        const Vec3 d = glm::abs(a.color.pixels[i] - b.color.pixels[i]);
        largest = std::max({largest, d.x, d.y, d.z});
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "forward differences: the thesis's quadratic takes its values by steps of 12, 16, 20"
    * technique("fakephong.forward-difference")) {
    auto row = difference_table<std::int64_t>(2, [](int x, int y) {
                   return printed_quadratic(x, 3 + y);
               }).rows[0];
    CHECK(row.of_order[1] == 12);
    CHECK(row.of_order[2] == 4);
    for (const std::int64_t wanted : {-16, -4, 12, 32, 56, 84}) {
        CHECK(row.of_order[0] == wanted);
        step(row);
    }
    auto linear = difference_table<std::int64_t>(1, [](int x, int y) { return 7 * x - 2 * y; });
    for (int i = 0; i < 5; ++i) {
        CHECK(linear.rows[0].of_order[1] == 7);
        step_right(linear);
    }
}

TEST_CASE(
    "forward differences: steps right, left and down give the polynomial's values"
    * technique("fakephong.forward-difference")) {
    for (const std::size_t degree : {1u, 2u, 3u}) {
        CAPTURE(degree);
        const auto f = [degree](int x, int y) -> std::int64_t {
            const std::int64_t linear = 3 * x - 5 * y + 2;
            const std::int64_t quadratic = degree > 1 ? printed_quadratic(x, y) : 0;
            return linear + quadratic + (degree > 2 ? x * x * y - 2 * y * y * y + x * y * y : 0);
        };
        auto table = difference_table<std::int64_t>(degree, f);
        const auto start = table;
        int x = 0;
        int y = 0;
        for (const char step : std::string("rrdlllddrrrrdlrdll")) {
            if (step == 'r') {
                step_right(table);
                ++x;
            } else if (step == 'l') {
                step_left(table);
                --x;
            } else {
                step_down(table);
                ++y;
            }
            REQUIRE(table.rows[0].of_order[0] == f(x, y));
        }
        auto there = start;
        step_right(there);
        step_left(there);
        for (std::size_t i = 0; i <= degree; ++i) {
            CHECK(there.rows[i].of_order == start.rows[i].of_order);
        }
    }
}

TEST_CASE(
    "forward differences: a quadratic costs 2 additions, not 4 and 3 multiplications"
    * technique("fakephong.forward-difference")) {
    const Real a = 2, b = 3, d = 1, y = 3;
    auto row = difference_table<Real>(2, [](int i, int j) {
                   return Real(static_cast<double>(printed_quadratic(i, 3 + j)));
               }).rows[0];
    Work before = counted_work;
    step(row);
    Work done = counted_work - before;
    CHECK(done.additions == 2);
    CHECK(done.multiplications == 0);

    before = counted_work;
    const Real x = 0;
    const Real next = -16.0 + (2.0 * a * x + a + b * y + d);  // f(0, 3) is -16
    done = counted_work - before;
    CHECK(next.value == -4);
    CHECK(done.additions == 4);
    CHECK(done.multiplications == 3);
}

TEST_CASE("forward differences: over a row of 4,096 pixels a cubic drifts by less than 1e-6") {
    const auto f = [](int x, int y) {
        const double s = x / 4096.0;
        const double t = y / 4096.0;
        return Real(s * s * s - 1.5 * s * s + 0.6 * s + 0.3 * t * s - t);
    };
    auto row = difference_table<Real>(3, f).rows[0];
    double largest = 0;
    for (int x = 0; x < 4096; ++x) {
        largest = std::max(largest, std::abs(row.of_order[0].value - f(x, 0).value));
        step(row);
    }
    CHECK(largest < 1e-6);
    CHECK(largest > 0);
}

TEST_CASE(
    "forward differences: without perspective a method's image equals evaluation at each pixel"
    * technique("fakephong.forward-difference")) {
    for (const PhongScene& scene : stepped_scenes()) {
        for (const char* id : {"gouraud", "quadratic", "cubic"}) {
            CAPTURE(scene.name);
            CAPTURE(std::string(id));
            const ShadingMethod& method = *find_method(id);
            const PhongImage direct = draw(scene, method);
            const PhongImage stepped = draw(scene, method, Evaluation::Differences);
            CHECK(stepped.pixels == direct.pixels);
            CHECK(stepped.mask == direct.mask);
            CHECK(stepped.setup.lightings == direct.setup.lightings);
            CHECK(largest_difference(direct, stepped) < 1e-6f);
        }
    }
}

TEST_CASE("forward differences: a pixel takes six additions per degree and no multiplication") {
    // Six: three channels of what is tinted and three of the highlight. Ten samples and the walk
    // along the left edge are a hundredth of that on one large triangle.
    const PhongScene scene = on_screen(triangle_scene());
    for (const char* id : {"gouraud", "quadratic", "cubic"}) {
        CAPTURE(std::string(id));
        const ShadingMethod& method = *find_method(id);
        const PhongImage direct = draw(scene, method);
        const PhongImage stepped = draw(scene, method, Evaluation::Differences);
        const auto per_pixel = [&](std::int64_t count) {
            return static_cast<double>(count) / static_cast<double>(stepped.pixels);
        };
        const double additions = 6.0 * method.degree;
        CHECK(per_pixel(stepped.shading.additions) == near(additions).epsilon(0.05));
        CHECK(per_pixel(stepped.shading.multiplications) < 0.1);
        CHECK(per_pixel(direct.shading.multiplications) >= 2 * additions);
    }
}

TEST_CASE(
    "fakephong: with w = 1, 1, 3 the center of an edge from u = 0 to 1 on the screen is 1/4"
    * technique("fakephong.texmap")) {
    // Checks a quarter wide: the color changes where u is 1/4, 1/2 and 3/4.
    PhongScene scene = {.name = "edge", .lights = {{}}};
    scene.channels = Channels::Full;
    scene.material = {.ambient = 1, .diffuse = 0, .specular = 0, .checks = 4};
    scene.camera = {.eye = {0, 0, 1}, .half_size = 1, .size = 512};
    const auto first_change = [&](double w) {  // of the screen's width, along the lower edge
        scene.mesh = {
            .positions = {{-1, -1, 0}, {-1, 1, 0}, {w, -w, 1 - w}},
            .normals = std::vector<dvec3>(3, dvec3(0, 0, 1)),
            .uvs = {{0, 0}, {0, 0}, {1, 0}},
            .triangles = {{0, 2, 1}}};
        const PhongImage image = draw(scene, *find_method("gouraud"));
        const Vec3* const row = &image.color.pixels[std::size_t{508} * 512];
        int x = 0;
        while (x < 500 && row[x].x > 0.75f) {
            ++x;
        }
        return x / 512.0;
    };
    CHECK(first_change(3) == near(0.5).epsilon(0.01));
    CHECK(first_change(1) == near(0.25).epsilon(0.01));
    scene.interpolation = Interpolation::Screen;
    CHECK(first_change(3) == near(0.25).epsilon(0.01));
}

}  // namespace limn::fakephong::forward_difference_test
