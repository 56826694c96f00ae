#include "ecs/components/camera.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/lens/thin_lens.h"
#include "render/render_view.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::thin_lens_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// d(z) of the lens that post.circle-of-confusion uses: F = 50 mm, f/2, focused at 2 m.
double circle_at(double distance) {
    return circle_of_confusion(0.05, 2, 2, distance);
}

/// A camera somewhere, turned somehow, with a fast lens.
RenderView lens_camera(const LensView& lens) {
    RenderView view = make_render_view(
        Camera{}, look_at({3, 2, 5}, {0.5f, 1, -2}), look_at({3.1f, 2, 5}, {0.5f, 1, -2}),
        {.width = 640, .height = 360});
    view.lens = lens;
    return view;
}

/// Where in the world a direction (as slopes of the view) and a distance are.
Vec3 point_in_view(const RenderView& view, const Vec2& slope, float distance) {
    return transform_point(view.world_from_camera, {slope * distance, -distance});
}

/// Pixels from the left and the bottom.
Vec2 pixel_of(const RenderView& view, const Mat4& clip_from_world, const Vec3& point) {
    const Vec4 clip = clip_from_world * Vec4(point, 1);
    return (0.5f * Vec2(clip) / clip.w + 0.5f) * Vec2(view.width, view.height);
}
Vec2 pixel_of(const RenderView& view, const Vec3& point) {
    return pixel_of(view, view.clip_from_world, point);
}

/// Equally many points in each of `side` x `side` equal squares of the unit square, on the
/// aperture.
std::vector<Vec2> aperture_points(const LensView& lens, int side) {
    std::vector<Vec2> points;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const Vec2 square = (Vec2(x, y) + 0.5f) / static_cast<float>(side);
            points.push_back(point_on_aperture(lens, square));
        }
    }
    return points;
}

float cross(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}

}  // namespace

TEST_CASE(
    "thin_lens: circles of confusion of the specified lens"
    * technique("post.circle-of-confusion")) {
    CHECK(circle_at(2) == 0);
    CHECK(circle_at(1) == test::near(6.410256e-4).epsilon(1e-6));
    CHECK(circle_at(4) == test::near(3.205128e-4).epsilon(1e-6));
    CHECK(circle_at(8) == test::near(4.807692e-4).epsilon(1e-6));
    CHECK(circle_at(kInfinity) == test::near(6.410256e-4).epsilon(1e-6));
    CHECK(circle_at(1e9) == test::near(circle_at(kInfinity)).epsilon(1e-6));
}

TEST_CASE(
    "thin_lens: the circle is the cone of light cut by the film"
    * technique("post.circle-of-confusion")) {
    const double film = 1 / (1 / 0.05 - 1 / 2.0);
    for (const double z : {0.3, 0.9, 1.5, 2.5, 7.0, 100.0}) {
        const double image = 1 / (1 / 0.05 - 1 / z);
        const double cone = 0.05 / 2 * std::abs(film - image) / image;
        CHECK(circle_at(z) == test::near(cone).epsilon(1e-6));
    }
}

TEST_CASE(
    "thin_lens: half the f-number doubles the circle, which grows away from the focus"
    * technique("post.circle-of-confusion")) {
    CHECK(circle_of_confusion(0.05, 1, 2, 5) == test::near(2 * circle_at(5)));
    double before = 0;
    for (double z = 1.99; z > 0.1; z -= 0.01) {
        CHECK(circle_at(z) > before);
        before = circle_at(z);
    }
    before = 0;
    for (double z = 2.01; z < 1000; z *= 1.02) {
        CHECK(circle_at(z) > before);
        before = circle_at(z);
    }
}

TEST_CASE(
    "thin_lens: the circle is linear in 1 / z, not in the distance from the focus"
    * technique("post.circle-of-confusion")) {
    const auto by_inverse = [](double inverse) { return circle_at(1 / inverse); };
    CHECK(by_inverse(0.1) - by_inverse(0.2) == test::near(by_inverse(0.2) - by_inverse(0.3)));
    CHECK(circle_at(8) - circle_at(6) < 0.5 * (circle_at(4) - circle_at(2)));
}

TEST_CASE("thin_lens: every focus in front of the camera is beyond the focal length") {
    CHECK(focal_length(2 * std::atan(0.012 / 0.05), 0.024, kInfinity) == test::near(0.05));
    for (const double focus : {1e-3, 0.01, 0.05, 0.3, 10.0}) {
        const double length = focal_length(0.5, 0.024, focus);
        CHECK(length < focus);
        CHECK(1 / (1 / length - 1 / focus) == test::near(0.012 / std::tan(0.25)));
    }
}

TEST_CASE("thin_lens: circles in pixels match those on the film") {
    const Camera camera{.fov_y = 0.6f};
    const Lens lens = {.f_number = 1.8f, .focus_distance = 0.7f, .sensor_height = 0.03f};
    const LensView view = *make_lens_view(lens, camera);
    const float scale = circle_scale(view, std::tan(0.3f), 720);
    const double length = focal_length(0.6, 0.03, 0.7);
    for (const float z : {0.2f, 0.5f, 0.9f, 20.0f}) {
        const double on_film = circle_of_confusion(length, 1.8, 0.7, static_cast<double>(z));
        const double pixels = on_film / 0.03 * 720;
        CHECK(std::abs(scale * (1 / 0.7f - 1 / z)) == test::near(pixels).epsilon(1e-4));
    }
}

TEST_CASE("thin_lens: an invalid lens is refused in one line") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Camera camera;
    for (const float bad : {0.0f, -2.8f, nan}) {
        const Result<LensView> aperture = make_lens_view({.f_number = bad}, camera);
        REQUIRE(!aperture.ok());
        CHECK(aperture.error().message.find("lens: f_number is ") == 0);
        const Result<LensView> focus = make_lens_view({.focus_distance = bad}, camera);
        REQUIRE(!focus.ok());
        CHECK(focus.error().message.find("lens: focus_distance is ") == 0);
        const Result<LensView> sensor = make_lens_view({.sensor_height = bad}, camera);
        REQUIRE(!sensor.ok());
        CHECK(sensor.error().message.find("lens: sensor_height is ") == 0);
    }
    CHECK(make_lens_view({.f_number = INFINITY}, camera)->aperture_radius == 0);
    const LensView far = *make_lens_view({.focus_distance = INFINITY}, camera);
    CHECK(far.aperture_radius > 0);
    CHECK(std::isfinite(far.aperture_radius));
    const LensView odd =
        *make_lens_view({.blades = -3, .blade_rotation = nan, .max_blur = nan}, camera);
    CHECK(odd.blades == 0);
    CHECK(odd.blade_rotation == 0);
    CHECK(odd.max_blur == 0);
}

TEST_CASE("thin_lens: a camera with an invalid lens is a pinhole") {
    World world;
    const Entity camera = world.create(Camera{}, WorldTransform{}, Lens{});
    CHECK(make_render_view(world, camera).lens.aperture_radius > 0);
    world.get<Lens>(camera).f_number = -1;
    const RenderView view = make_render_view(world, camera);
    CHECK(view.lens.aperture_radius == 0);
    CHECK(view.clip_from_world == make_render_view(Camera{}, {}, {}).clip_from_world);
}

TEST_CASE("thin_lens: through every point of the lens a point in focus has the same pixel") {
    for (const int blades : {0, 5}) {
        const RenderView view =
            lens_camera({.aperture_radius = 0.05f, .focus_distance = 4, .blades = blades});
        for (const Vec2& p : aperture_points(view.lens, 8)) {
            const RenderView sample = with_lens_sample(view, p);
            CHECK(sample.lens.aperture_radius == 0);
            for (const Vec2& slope : {Vec2(0), Vec2(0.3f, 0.1f), Vec2(-0.5f, 0.35f)}) {
                const Vec3 sharp = point_in_view(view, slope, 4);
                CHECK(glm::distance(pixel_of(sample, sharp), pixel_of(view, sharp)) < 2e-3f);
            }
        }
    }
}

TEST_CASE("thin_lens: the lens images a point as a disc as wide as its circle of confusion") {
    const RenderView view = lens_camera({.aperture_radius = 0.02f, .focus_distance = 2});
    const float scale = circle_scale(view.lens, view.tangent.y, view.height);
    for (const float z : {0.5f, 1.0f, 1.7f, 3.0f, 10.0f, 1000.0f}) {
        const Vec3 point = point_in_view(view, {0.1f, -0.2f}, z);
        const float radius = 0.5f * scale * (1 / 2.0f - 1 / z);
        for (const Vec2& p : aperture_points(view.lens, 6)) {
            // Beyond the focus the disc stands as the aperture does, before it on its head.
            const Vec2 moved = pixel_of(with_lens_sample(view, p), point) - pixel_of(view, point);
            CHECK(glm::distance(moved, radius * p) < 2e-3f);
        }
    }
}

TEST_CASE("thin_lens: a lens sample moves the eye, and keeps the jitter and the motion") {
    const RenderView steady = lens_camera({.aperture_radius = 0.03f, .focus_distance = 2});
    const RenderView view = with_jitter(steady, {0.25f, -0.5f});
    const Vec2 p = {0.6f, -0.3f};
    const RenderView sample = with_lens_sample(view, p);
    const Vec3 eye = transform_point(view.world_from_camera, {0.03f * p, 0});
    CHECK(glm::distance(transform_point(sample.world_from_camera, {0, 0, 0}), eye) < 1e-6f);
    const Vec2 apart = sample.jitter - with_lens_sample(steady, p).jitter;
    CHECK(glm::distance(apart, {0.25f, -0.5f}) < 1e-5f);

    // As if the camera had stood there in both moments.
    Affine before = look_at({3.1f, 2, 5}, {0.5f, 1, -2});
    for (Vec4& row : before.row) {
        row.w += 0.03f * (p.x * row.x + p.y * row.y);
    }
    const RenderView there =
        make_render_view(Camera{}, sample.world_from_camera, before, {.width = 640, .height = 360});
    const Vec3 point = point_in_view(view, {0.2f, 0.1f}, 1.5f);
    CHECK(
        glm::distance(
            pixel_of(view, sample.unjittered_from_world, point),
            pixel_of(view, there.unjittered_from_world, point))
        < 2e-3f);
    CHECK(
        glm::distance(
            pixel_of(view, sample.previous_clip_from_world, point),
            pixel_of(view, there.previous_clip_from_world, point))
        < 2e-3f);
}

TEST_CASE("thin_lens: a pinhole has a single sample, the view itself") {
    const RenderView view = lens_camera({});
    for (const Vec2& p : {Vec2(0), Vec2(1, 0), Vec2(-0.3f, 0.7f)}) {
        const RenderView sample = with_lens_sample(view, p);
        CHECK(sample.clip_from_world == view.clip_from_world);
        CHECK(sample.previous_clip_from_world == view.previous_clip_from_world);
        CHECK(sample.jitter == view.jitter);
        for (int i = 0; i < 3; ++i) {
            CHECK(sample.world_from_camera.row[i] == view.world_from_camera.row[i]);
        }
    }
}

TEST_CASE("thin_lens: the tangents of a view shifted by a lens sample enclose its image") {
    const RenderView view = lens_camera({.aperture_radius = 0.05f, .focus_distance = 1});
    const RenderView sample = with_lens_sample(view, {0.8f, -0.5f});
    const Vec2 widest = widest_tangent(sample);
    const Vec2 size = {view.width, view.height};
    for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
        const Vec2 ndc = 2.0f * corner - 1.0f - 2.0f * sample.jitter / size;
        const Vec2 slope = glm::abs(ndc * view.tangent);
        CHECK(slope.x < widest.x * 1.003f);
        CHECK(slope.y < widest.y * 1.003f);
    }
    CHECK(widest_tangent(view) == view.tangent);
    CHECK(widest_tangent(with_jitter(view, {0.5f, -0.4f})) == view.tangent);
}

TEST_CASE("thin_lens: equal areas of the square map to equal areas of the aperture") {
    for (const int blades : {0, 3, 6, 7}) {
        const LensView lens = {.blades = blades, .blade_rotation = 0.4f};
        const std::vector<Vec2> points = aperture_points(lens, 120);
        const auto count = static_cast<float>(points.size());
        Vec2 mean(0);
        float second = 0;
        for (const Vec2& p : points) {
            CHECK(glm::length(p) <= 1.0f);
            mean += p / count;
            second += glm::dot(p, p) / count;
        }
        CHECK(glm::length(mean) < 1e-3f);
        // Of a disc 1/2; of a polygon (2 + cos(2 pi / n)) / 6.
        const float n = static_cast<float>(blades);
        const float expected = blades == 0 ? 0.5f : (2 + std::cos(2 * kPi / n)) / 6;
        CHECK(second == test::near(expected).epsilon(2e-3));

        // A small disc anywhere contains points in proportion to its area.
        const float area = blades == 0 ? kPi : 0.5f * n * std::sin(2 * kPi / n);
        for (const Vec2& center : {Vec2(0, 0), Vec2(0.1f, 0.2f), Vec2(-0.25f, 0.1f)}) {
            const auto inside = std::count_if(points.begin(), points.end(), [&](const Vec2& p) {
                return glm::distance(p, center) < 0.2f;
            });
            const float fraction = kPi * square(0.2f) / area;
            CHECK(static_cast<float>(inside) / count == test::near(fraction).epsilon(0.03));
        }
    }
}

TEST_CASE("thin_lens: a bladed aperture is a regular polygon with the specified first corner") {
    const LensView lens = {.blades = 5, .blade_rotation = 0.4f};
    CHECK(glm::distance(point_on_aperture(lens, {0, 1}), {std::cos(0.4f), std::sin(0.4f)}) < 1e-6f);
    for (const Vec2& p : aperture_points(lens, 40)) {
        for (int i = 0; i < 5; ++i) {
            const float angle = 0.4f + 2 * kPi * static_cast<float>(i) / 5;
            const Vec2 a = {std::cos(angle), std::sin(angle)};
            const Vec2 b = {std::cos(angle + 0.4f * kPi), std::sin(angle + 0.4f * kPi)};
            CHECK(cross(b - a, p - a) > -1e-5f);
        }
    }
}

}  // namespace limn::thin_lens_test
