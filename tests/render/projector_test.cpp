#include "ecs/components/projector.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "render/light/projector_list.h"
#include "tests/near.h"
#include "tests/render/shadow_fixture.h"
#include "tests/technique.h"

namespace limn::test::projector_test {
namespace {

/// Four squares: red, green above; blue, white below.
ImageData four_colors(int side = 16) {
    ImageData image;
    image.width = image.height = side;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const bool right = x >= side / 2;
            const bool below = y >= side / 2;
            const auto on = [](bool lit) { return lit ? std::uint8_t{255} : std::uint8_t{0}; };
            image.pixels.insert(
                image.pixels.end(),
                {on(right == below && (below || !right)), on(right), on(below), 255});
        }
    }
    return image;
}

/// A wall in z = 0 that a lamp at (0, 0, 2) throws its image on.
struct WallScene : ShadowTest {
    WallScene() {
        place(add(make_square()), white, affine_from({0, 0, 0}, {1, 0, 0, 0}, {4, 4, 1}));
        lamp = shine(
            SpotLight{
                .intensity = 10,
                .radius = 0,
                .attenuation = {.falloff = Falloff::None},
                .inner_angle = radians(50.0f),
                .outer_angle = radians(50.0f)},
            at({0, 0, 2}));
    }
    /// Light at a point of the wall, viewed from the front.
    Vec3 at_wall(const gpu::FloatImage& image, const Vec2& p) const {
        const auto pixel = [](float x) { return static_cast<int>((x / 3 * 0.5f + 0.5f) * 96); };
        return rgb_at(image, pixel(p.x), pixel(-p.y));
    }
    gpu::FloatImage wall() { return radiance(look({0, 0, 3}, {0, 0, 0}, 96, 96)); }

    Entity lamp;
};

}  // namespace

TEST_CASE(
    "projector: ten frames at 5 a second show frame 0 at 2 s and frame 9 at 1.9 s"
    * technique("shadow.projector")) {
    const Projector film = {.columns = 5, .rows = 2, .frames = 10, .fps = 5};
    CHECK(projector_frame(film, 2.0) == 0);
    CHECK(projector_frame(film, 1.9) == 9);
    CHECK(projector_frame(film, 0.0) == 0);
    CHECK(projector_frame(film, 0.2) == 1);
    CHECK(projector_frame(film, -0.1) == 9);  // as it went on before
    Projector once = film;
    once.loop = false;
    CHECK(projector_frame(once, 7.0) == 9);
    CHECK(projector_frame(once, -7.0) == 0);
    once.frames = 99;  // no more than there are
    CHECK(projector_frame(once, 1e9) == 9);
    once.fps = std::nanf("");
    CHECK(projector_frame(once, 1) == 0);
}

TEST_CASE_FIXTURE(
    WallScene,
    "projector: at distance d the image is 2 d tan(fov / 2) wide, upright, and black outside"
        * technique("shadow.projector")) {
    const float fov = radians(40.0f);
    world.add(lamp, Projector{.image = add(four_colors()), .width = fov});
    const gpu::FloatImage image = wall();
    const float half = 2 * std::tan(0.5f * fov);  // at 2 m
    const Vec3 red = at_wall(image, {-0.5f * half, 0.5f * half});
    CHECK(red.x > 0.5f);
    CHECK(red.y == test::near(0).scale(1));
    // Viewed from in front of the wall, the lamp's right is ours.
    const Vec3 green = at_wall(image, {0.5f * half, 0.5f * half});
    CHECK(green.y > 0.5f);
    CHECK(green.z == test::near(0).scale(1));
    const Vec3 blue = at_wall(image, {-0.5f * half, -0.5f * half});
    CHECK(blue.z > 0.5f);
    CHECK(blue.x == test::near(0).scale(1));
    int lit = 0;
    for (int x = 0; x < 96; ++x) {
        lit += rgb_at(image, x, 40).x + rgb_at(image, x, 40).y > 0 ? 1 : 0;
    }
    CHECK(lit == test::near(2 * half / 6 * 96).epsilon(0.04));
    CHECK(at_wall(image, {1.1f * half, 0}) == Vec3(0));
    CHECK(at_wall(image, {0, -1.1f * half}) == Vec3(0));
}

TEST_CASE(
    "projector: a point behind it is unlit, and one on its axis gets the image center"
    * technique("shadow.projective-matrix")) {
    const Affine pose = look_at({1, 2, 3}, {1, 0, 3});
    const auto record = make_projector_record({}, LightKind::Spot, pose, 0, 0);
    for (const float distance : {0.5f, 3.0f, 40.0f}) {
        const Vec4 ahead = {1, 2 - distance, 3, 1};
        const float q = glm::dot(record.row_q, ahead);
        CHECK(q == test::near(distance));
        CHECK(glm::dot(record.row_s, ahead) / q == test::near(0.5));
        CHECK(glm::dot(record.row_t, ahead) / q == test::near(0.5));
    }
    CHECK(glm::dot(record.row_q, Vec4(1, 4, 3, 1)) < 0);
}

TEST_CASE_FIXTURE(
    WallScene, "projector: an object in front of the wall occludes the image"
                   * technique("shadow.projector")) {
    world.add(lamp, Projector{.image = add(four_colors()), .width = radians(60.0f)});
    world.add(lamp, Shadow{.resolution = 256});
    const gpu::FloatImage open = wall();
    place(add(make_square()), white, affine_from({0, 0, 1}, {1, 0, 0, 0}, {0.2f, 0.2f, 1}));
    // Past the square, the wall: 0.4 m wide at 1 m, its shadow 0.8 m at 2 m.
    const gpu::FloatImage shaded = wall();
    CHECK(at_wall(open, {0.36f, 0.36f}).y > 0.5f);
    CHECK(at_wall(shaded, {0.36f, 0.36f}).y < 0.01f);
    CHECK(at_wall(shaded, {0.6f, 0.6f}).y > 0.5f);
}

TEST_CASE_FIXTURE(
    WallScene, "projector: an image sequence advances with time" * technique("shadow.projector")) {
    world.add(
        lamp, Projector{
                  .image = add(four_colors()),
                  .width = radians(40.0f),
                  .columns = 2,
                  .rows = 2,
                  .frames = 4,
                  .fps = 1});
    for (int frame = 0; frame < 4; ++frame) {
        FrameTime time;
        time.time = frame + 0.5;
        world.insert_resource(time);
        const Vec3 color = at_wall(wall(), {0.1f, 0.1f});
        CAPTURE(frame);
        CHECK((color.x > 0.5f) == (frame == 0 || frame == 3));
        CHECK((color.y > 0.5f) == (frame == 1 || frame == 3));
        CHECK((color.z > 0.5f) == (frame == 2 || frame == 3));
    }
}

TEST_CASE_FIXTURE(
    WallScene, "projector: where a pixel covers many texels it shows their mean"
                   * technique("shadow.projector")) {
    ImageData fine;
    fine.width = fine.height = 512;
    fine.srgb = false;
    for (int i = 0; i < 512 * 512; ++i) {
        const auto on = static_cast<std::uint8_t>((i + i / 512) % 2 == 0 ? 255 : 0);
        fine.pixels.insert(fine.pixels.end(), {on, on, on, 255});
    }
    const gpu::FloatImage plain = wall();
    world.add(lamp, Projector{.image = add(std::move(fine)), .width = radians(60.0f)});
    const gpu::FloatImage grey = wall();
    for (int y = 36; y < 60; ++y) {
        for (int x = 36; x < 60; ++x) {
            REQUIRE(rgb_at(grey, x, y).x == test::near(0.5f * rgb_at(plain, x, y).x).epsilon(0.02));
        }
    }
}

TEST_CASE_FIXTURE(WallScene, "projector: the image is the same with every light method") {
    world.add(lamp, Projector{.image = add(four_colors()), .width = radians(40.0f)});
    const gpu::FloatImage clustered = wall();
    CHECK(at_wall(clustered, {-0.3f, 0.3f}).x > 0.5f);
    using enum LightMethod;
    for (const LightMethod method : {FullScreen, Volumes, ObjectMajor, LightMajor}) {
        world.insert_resource(Rendering{method});
        CAPTURE(static_cast<int>(method));
        CHECK(largest_difference(clustered, wall()) < 1.0f / 255);
    }
}

TEST_CASE_FIXTURE(
    WallScene,
    "projector: a sun projects its image along its light, equally wide at any distance") {
    world.destroy(lamp);
    const Entity sun = shine(DirectionalLight{.illuminance = 5}, at({0, 0, 2}));
    world.add(sun, Projector{.image = add(four_colors()), .width = 2});
    const gpu::FloatImage image = wall();
    CHECK(at_wall(image, {-0.8f, 0.8f}).x > 0.5f);
    CHECK(at_wall(image, {0.8f, 0.8f}).y > 0.5f);
    CHECK(at_wall(image, {1.15f, 0.5f}) == Vec3(0));
}

TEST_CASE_FIXTURE(
    WallScene, "projector: without an image, or with invalid values, the light is finite") {
    const gpu::FloatImage plain = wall();
    world.add(lamp, Projector{});
    CHECK(largest_difference(plain, wall()) == 0);
    world.add(lamp, Projector{.image = {4711}});
    CHECK(largest_difference(plain, wall()) == 0);
    const float nan = std::nanf("");
    const ImageId image = add(four_colors());
    world.add(
        lamp, Projector{
                  .image = image,
                  .width = nan,
                  .aspect = -1,
                  .columns = 0,
                  .rows = -3,
                  .frames = -1,
                  .fps = nan});
    for (const float value : wall().pixels) {
        REQUIRE(std::isfinite(value));
    }
}

}  // namespace limn::test::projector_test
