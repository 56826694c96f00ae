// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/base/rotation.h"
#include "ecs/components/panorama_layer.h"
#include "tests/near.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

namespace limn::test::panorama_layer_test {
namespace {

constexpr double kTurn = 6.283185307179586;

using Picture = std::function<Vec4(double x, double y)>;  ///< of 0 .. 1, from the upper left

ImageData paint(int width, int height, const Picture& picture) {
    ImageData image;
    image.name = "painted";
    image.width = width;
    image.height = height;
    image.format = PixelFormat::Rgba32F;
    std::vector<Vec4> pixels;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            pixels.push_back(picture((x + 0.5) / width, (y + 0.5) / height));
        }
    }
    image.pixels.resize(pixels.size() * sizeof(Vec4));
    std::memcpy(image.pixels.data(), pixels.data(), image.pixels.size());
    return image;
}

ImageData plain(const Vec3& color, float alpha = 1) {
    return paint(4, 4, [&](double, double) { return Vec4(color, alpha); });
}

/// A smooth color of a direction: what a layer is painted with, and should show.
Vec3 color_toward(const glm::dvec3& d) {
    return Vec3(0.5 + 0.4 * glm::normalize(d));
}

struct Surroundings : Scene {
    Entity add_layer(const PanoramaLayer& layer, const Quat& rotation = {1, 0, 0, 0}) {
        return world.create(layer, WorldTransform{affine_from({40, 3, -7}, rotation, Vec3(2))});
    }
    /// Within a quarter of a degree of a direction.
    Vec3 seen(const Vec3& direction) {
        const Affine pose = look_at({0, 0, 0}, direction);
        return rgb_at(
            radiance(make_render_view(
                {.fov_y = radians(0.25f), .near = 0.05f}, pose, pose, {.width = 1, .height = 1})),
            0, 0);
    }
    /// Six pictures of color_toward(), as photographs of right, left, up, down, front and back.
    std::vector<ImageId> paint_faces(int size) {
        struct Photograph {
            glm::dvec3 ahead, right, up;
        };
        const Photograph photographs[] = {
            {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
            {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
            {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},
        };
        std::vector<ImageId> faces;
        for (const Photograph& at : photographs) {
            faces.push_back(add(paint(size, size, [&](double x, double y) {
                return Vec4(
                    color_toward(at.ahead + (2 * x - 1) * at.right + (1 - 2 * y) * at.up), 1);
            })));
        }
        return faces;
    }
};

std::vector<Vec3> directions() {
    std::vector<Vec3> all;
    for (int i = 0; i < 24; ++i) {
        for (int j = -5; j <= 5; ++j) {
            const float phi = 0.2617994f * static_cast<float>(i) + 0.01f;
            const float height = 0.31f * static_cast<float>(j);
            all.push_back(glm::normalize(Vec3(std::sin(phi), height, -std::cos(phi))));
        }
    }
    return all;
}

}  // namespace

TEST_CASE_FIXTURE(
    Surroundings,
    "panorama layer: six faces show what was photographed, without seams at their edges"
        * technique("engine.panorama")) {
    add_layer({.faces = paint_faces(64)});
    for (const Vec3& direction : directions()) {
        CAPTURE(direction.x);
        CAPTURE(direction.y);
        CAPTURE(direction.z);
        CHECK(glm::distance(seen(direction), color_toward(direction)) < 0.01f);
    }
    // Across each edge between two faces.
    for (const Vec3& edge :
         {Vec3(1, 0.2f, 1), Vec3(-1, 0.4f, 1), Vec3(0.3f, 1, -1), Vec3(1, -1, 0.1f)}) {
        const Vec3 across = 0.002f * glm::normalize(Vec3(edge.x, edge.y, -edge.z));
        CHECK(glm::distance(seen(edge + across), seen(edge - across)) < 0.01f);
    }
}

TEST_CASE_FIXTURE(
    Surroundings,
    "panorama layer: the camera's position changes nothing, its direction and the layer's rotation "
    "do" * technique("engine.panorama")) {
    const Entity layer = add_layer({.faces = paint_faces(64)});
    const auto draw_from = [&](const Vec3& eye, const Vec3& direction) {
        return radiance(look(eye, eye + direction, 16, 16));
    };
    const gpu::FloatImage here = draw_from({0, 0, 0}, {0.3f, 0.1f, -1});
    CHECK(largest_difference(here, draw_from({900, -40, 17}, {0.3f, 0.1f, -1})) < 1e-3f);
    CHECK(largest_difference(here, draw_from({0, 0, 0}, {1, 0.1f, 0.3f})) > 0.2f);
    const Quat quarter = rotation_about({0, 1, 0}, radians(90.0f));
    world.get<WorldTransform>(layer).world = affine_from({0, 0, 0}, quarter, Vec3(3));
    for (const Vec3& direction : directions()) {
        const Vec3 turned = glm::inverse(quarter) * direction;
        CHECK(glm::distance(seen(direction), color_toward(turned)) < 0.01f);
    }
}

TEST_CASE_FIXTURE(
    Surroundings,
    "panorama layer: a strip has the horizon in its middle, repeats, and has no seam behind"
        * technique("engine.panorama")) {
    constexpr int kRepeat = 3;
    const float half = radians(20.0f);
    const auto hue = [](double x) { return 0.5 + 0.4 * std::cos(kTurn * x); };
    const ImageId strip =
        add(paint(256, 64, [&](double x, double y) { return Vec4(hue(x), y, 0.2, 1); }));
    add_layer({.image = strip, .half_angle = half, .repeat = kRepeat});
    for (int i = 0; i < 100; ++i) {
        const double longitude = kTurn * (i - 50) / 100.0;
        for (const double height : {-0.3, -0.1, 0.0, 0.2, 0.34}) {
            CAPTURE(i);
            CAPTURE(height);
            const Vec3 got = seen(
                {static_cast<float>(std::sin(longitude)), static_cast<float>(height),
                 static_cast<float>(-std::cos(longitude))});
            CHECK(got.x == test::near(hue(kRepeat * (longitude / kTurn + 0.5))).epsilon(0.02));
            CHECK(got.y == test::near(0.5 - 0.5 * height / std::tan(half)).scale(1).epsilon(0.01));
        }
    }
    CHECK(seen({0.1f, std::tan(half) * 1.01f, -1}) == Vec3(0));
    // Below the strip its lowest row goes on.
    CHECK(seen({0.1f, -3, -1}).y == test::near(63.5f / 64).epsilon(0.01));
    // In an image the smallest mip level must not show behind, where the longitude jumps.
    const gpu::FloatImage behind = radiance(look({0, 0, 0}, {0, 0, 1}, 65, 65));
    for (int x = 1; x < 65; ++x) {
        CHECK(std::abs(rgb_at(behind, x, 32).x - rgb_at(behind, x - 1, 32).x) < 0.1f);
    }
}

TEST_CASE_FIXTURE(
    Surroundings,
    "panorama layer: a strip whose texels are much wider than high keeps its edges sharp"
        * technique("engine.panorama")) {
    // A pixel covers 0.7 texels across and 8 down; a stripe and the next are 8 texels apart.
    constexpr int kStripes = 32;
    const auto hue = [](double x) { return 0.5 + 0.4 * std::cos(kTurn * kStripes * x); };
    add_layer(
        {.image = add(paint(256, 256, [&](double x, double) { return Vec4(hue(x), 0.3, 0, 1); })),
         .half_angle = radians(15.0f),
         .repeat = 1});
    for (const float roll : {0.0f, 45.0f, 90.0f}) {  // of the camera
        CAPTURE(roll);
        const Affine pose =
            affine_from({0, 0, 0}, rotation_about({0, 0, 1}, radians(roll)), Vec3(1));
        const gpu::FloatImage image = radiance(make_render_view(
            {.fov_y = radians(60.0f), .near = 0.05f}, pose, pose, {.width = 65, .height = 65}));
        for (int i = 0; i < 65; ++i) {
            CAPTURE(i);
            // Along the horizon.
            const double stretch = roll == 45.0f ? std::sqrt(2.0) : 1;
            const double across = stretch * (i + 0.5 - 32.5) / 32.5 * std::tan(kTurn / 12);
            const Vec3 got = rgb_at(image, roll == 90.0f ? 32 : i, roll == 0.0f ? 32 : i);
            CHECK(std::abs(got.x - hue(std::atan(across) / kTurn + 0.5)) < 0.06);
            CHECK(got.y == test::near(0.3).epsilon(0.01));
        }
    }
}

TEST_CASE_FIXTURE(
    Surroundings, "panorama layer: layers blend by their opacity in the order of their entities"
                      * technique("engine.panorama")) {
    const Vec3 far = {0.8f, 0.2f, 0.4f};
    const Vec3 near = {0.1f, 0.9f, 0.3f};
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {2, 3, 4}});
    const Vec3 sky = seen({0, 0, -1});
    const Entity first = add_layer({.image = add(plain(far)), .opacity = 0.6f});
    const Entity second =
        add_layer({.image = add(plain(near, 0.5f)), .color = {2, 2, 2}, .opacity = 0.8f});
    const Vec3 expected = glm::mix(glm::mix(sky, far, 0.6f), 2.0f * near, 0.4f);
    CHECK(glm::distance(seen({0.2f, 0.1f, -1}), expected) < 0.005f);
    world.get<PanoramaLayer>(first).opacity = 0;
    CHECK(glm::distance(seen({0, 0, -1}), glm::mix(sky, 2.0f * near, 0.4f)) < 0.005f);
    world.get<PanoramaLayer>(second).opacity = 0;
    CHECK(seen({0, 0, -1}) == sky);
}

TEST_CASE_FIXTURE(
    Surroundings,
    "panorama layer: whatever has a surface hides it, and six images that are no cube are left out"
        * technique("engine.panorama")) {
    const Vec3 color = {0.3f, 0.6f, 0.9f};
    add_layer({.image = add(plain(color))});
    const Entity ball =
        place(add(make_ball()), add(Material{.base_color = Vec4(0, 0, 0, 1)}), at({0, 0, -3e5f}));
    CHECK(glm::distance(seen({0.1f, 0, -1}), color) < 0.005f);
    world.get<WorldTransform>(ball).world = affine_from({0, 0, -3e5f}, {1, 0, 0, 0}, Vec3(1e4f));
    CHECK(glm::length(seen({0, 0, -1})) < 0.1f);
    world.destroy(ball);
    // Of two sizes, too few, and without an image.
    std::vector<ImageId> faces(6, add(plain({1, 0, 0})));
    faces[2] = add(paint(8, 8, [](double, double) { return Vec4(1); }));
    add_layer({.faces = faces});
    add_layer({.faces = {faces[0], faces[0]}});
    faces[2] = {};
    add_layer({.faces = faces});
    CHECK(glm::distance(seen({0, 0, -1}), color) < 0.005f);
}

}  // namespace limn::test::panorama_layer_test
