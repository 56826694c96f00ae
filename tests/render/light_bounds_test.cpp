#include "render/light/light_list.h"
#include "render/render_view.h"
#include "render/shadow/light_bounds.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <random>

namespace limn::light_bounds_test {
namespace {

RenderView looking(const Vec3& eye, const Vec3& target, float near = 0.1f, Vec2 jitter = {0, 0}) {
    const Affine pose = look_at(eye, target);
    return make_render_view(
        {.fov_y = radians(60.0f), .near = near}, pose, pose,
        {.width = 320, .height = 180, .jitter = jitter});
}

class Random {
  public:
    float number(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random_);
    }
    Vec3 direction() {
        std::normal_distribution<float> normal;
        const float x = normal(random_);
        const float y = normal(random_);
        return normalize_or({x, y, normal(random_)}, {0, 1, 0});
    }

  private:
    std::mt19937 random_{11};
};

}  // namespace

TEST_CASE(
    "light_bounds: the slopes of a sphere's tangents match the closed form"
    * technique("shadow.light-scissor")) {
    const SlopeRange ahead = sphere_slopes(0, -10, 1, 0.1f);
    CHECK(ahead.high == test::near(0.1005038).epsilon(1e-5));
    CHECK(ahead.low == test::near(-0.1005038).epsilon(1e-5));
    const SlopeRange aside = sphere_slopes(3, -4, 1, 0.1f);
    CHECK(aside.low == test::near(0.4734014).epsilon(1e-5));
    CHECK(aside.high == test::near(1.1265986).epsilon(1e-5));
    for (const float k : {aside.low, aside.high}) {
        // The line x = -k z passes the center at the radius.
        CHECK(std::abs(3 - k * 4) / std::sqrt(1 + k * k) == test::near(1).epsilon(1e-4));
    }
}

TEST_CASE(
    "light_bounds: every visible point of a sphere is in the rectangle, which is tight"
    * technique("shadow.light-scissor")) {
    Random random;
    int visible_points = 0;
    for (int i = 0; i < 400; ++i) {
        const RenderView view =
            looking({0, 0, 0}, random.direction(), 0.3f, {random.number(-0.5f, 0.5f), 0.25f});
        const float radius = random.number(0.05f, 4);
        const Vec3 center = random.direction() * random.number(0, 8);
        const LightBounds bounds = light_bounds(view, center, radius);
        Vec2 low = Vec2(INFINITY);
        Vec2 high = Vec2(-INFINITY);
        for (int k = 0; k < 2000; ++k) {
            // Of the ball, not only its surface: the near plane cuts into it.
            const float r = k % 2 == 0 ? radius : radius * random.number(0, 1);
            const Vec4 clip = view.clip_from_world * Vec4(center + random.direction() * r, 1);
            const float depth = clip.z / clip.w;
            const Vec2 pixel = (0.5f * Vec2(clip) / clip.w + 0.5f) * Vec2(320, 180);
            if (clip.w < view.near || pixel.x < 0 || pixel.y < 0 || pixel.x > 320
                || pixel.y > 180) {
                continue;
            }
            ++visible_points;
            low = glm::min(low, pixel);
            high = glm::max(high, pixel);
            REQUIRE(pixel.x >= static_cast<float>(bounds.x) - 1e-3f);
            REQUIRE(pixel.y >= static_cast<float>(bounds.y) - 1e-3f);
            REQUIRE(pixel.x <= static_cast<float>(bounds.x + bounds.width) + 1e-3f);
            REQUIRE(pixel.y <= static_cast<float>(bounds.y + bounds.height) + 1e-3f);
            REQUIRE(depth >= bounds.depth_min * (1 - 1e-5f));
            REQUIRE(depth <= bounds.depth_max * (1 + 1e-5f));
        }
        // Exact: where the whole sphere is in sight, samples come near each side.
        const bool whole = bounds.x > 0 && bounds.y > 0 && bounds.x + bounds.width < 320
                           && bounds.y + bounds.height < 180;
        if (whole && bounds.depth_max < 1) {
            const float slack = 2 + 0.05f * static_cast<float>(bounds.width);
            CHECK(low.x - static_cast<float>(bounds.x) < slack);
            CHECK(low.y - static_cast<float>(bounds.y) < slack);
            CHECK(static_cast<float>(bounds.x + bounds.width) - high.x < slack);
            CHECK(static_cast<float>(bounds.y + bounds.height) - high.y < slack);
        }
    }
    CHECK(visible_points > 10000);
}

TEST_CASE(
    "light_bounds: from inside a light the rectangle is the whole image"
    * technique("shadow.light-scissor")) {
    const RenderView view = looking({0, 0, 0}, {0, 0, -1});
    const LightBounds bounds = light_bounds(view, {0.5f, 0.2f, 0.4f}, 1);
    CHECK(bounds.x == 0);
    CHECK(bounds.y == 0);
    CHECK(bounds.width == 320);
    CHECK(bounds.height == 180);
    CHECK(bounds.depth_max == 1);
    CHECK(light_bounds(view, {5, 5, 5}, INFINITY) == LightBounds{0, 0, 320, 180, 0, 1});
}

TEST_CASE(
    "light_bounds: a light behind the camera or off screen has an empty rectangle"
    * technique("shadow.depth-bounds")) {
    const RenderView view = looking({0, 0, 0}, {0, 0, -1});
    CHECK(is_empty(light_bounds(view, {0, 0, 3}, 1)));
    CHECK(is_empty(light_bounds(view, {0, 0, 0.95f}, 1)));  // ends before the near plane
    CHECK(is_empty(light_bounds(view, {30, 0, -5}, 1)));
    CHECK(is_empty(light_bounds(view, {0, -30, -5}, 1)));
    CHECK_FALSE(is_empty(light_bounds(view, {0, 0, -5}, 1)));
}

TEST_CASE("light_bounds: grow gives the tight union of two rectangles, in either order") {
    const LightBounds low = {2, 3, 4, 5, 0.2f, 0.4f};
    const LightBounds high = {10, 1, 6, 20, 0.1f, 0.3f};
    const LightBounds both = {2, 1, 14, 20, 0.1f, 0.4f};
    const auto grown = [](LightBounds bounds, const LightBounds& other) {
        grow(bounds, other);
        return bounds;
    };
    CHECK(grown(low, high) == both);
    CHECK(grown(high, low) == both);
    CHECK(grown(both, low) == both);
    CHECK(grown({}, low) == low);
    CHECK(grown(low, {}) == low);
}

TEST_CASE(
    "light_bounds: the depth range is that of the nearest and the farthest point"
    * technique("shadow.depth-bounds")) {
    const RenderView view = looking({0, 0, 0}, {0, 0, -1}, 1.0f);
    const LightBounds bounds = light_bounds(view, {0, 0, -10}, 1);
    // The book's window depth, 0 at near 1 and 1 at far 100, of our reversed one.
    const auto forward = [](float depth) {
        const double z = -1.0 / static_cast<double>(depth);
        return (100.0 * 1.0 / z + 100.0) / (100.0 - 1.0);
    };
    CHECK(forward(bounds.depth_max) == test::near(0.897868).epsilon(1e-6));
    CHECK(forward(bounds.depth_min) == test::near(0.918274).epsilon(1e-6));
}

TEST_CASE("light_bounds: the sphere around a cone contains it and is no larger than the light's") {
    Random random;
    for (const float angle : {5.0f, 30.0f, 44.0f, 46.0f, 70.0f, 89.0f}) {
        const Vec3 axis = random.direction();
        const LightRange range = {{1, 2, 3}, 4, axis, std::cos(radians(angle))};
        const RangeSphere sphere = range_sphere(range);
        CHECK(sphere.radius <= 4.001f);
        for (int i = 0; i < 2000; ++i) {
            const Vec3 direction = random.direction();
            if (glm::dot(direction, axis) >= range.cosine) {
                const Vec3 p = range.center + direction * random.number(0, 4);
                REQUIRE(glm::distance(p, sphere.center) <= sphere.radius * 1.0001f);
            }
        }
    }
    CHECK(range_sphere({{1, 2, 3}, 4}).radius == 4);
}

TEST_CASE(
    "caster_cull: a box is kept if its nearest point is within the light's radius"
    * technique("shadow.caster-cull")) {
    const Bounds box = {{2, 2, 2}, {3, 3, 3}};
    CHECK_FALSE(reaches_box({{0, 0, 0}, 3.4f}, box));
    CHECK(reaches_box({{0, 0, 0}, 3.5f}, box));
    CHECK(reaches_box({{2.5f, 2.5f, 2.5f}, 0}, box));
    CHECK(reaches_box({{0, 0, 0}, INFINITY}, box));
}

TEST_CASE(
    "caster_cull: no box that a spot's cone touches is culled, boxes behind it are"
    * technique("shadow.caster-cull")) {
    Random random;
    int dropped = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 axis = random.direction();
        const LightRange range = {{0, 0, 0}, 5, axis, std::cos(radians(random.number(5, 80)))};
        const Vec3 low = random.direction() * random.number(0, 6);
        const Bounds box = {low, low + Vec3(random.number(0.1f, 2))};
        const bool kept = reaches_box(range, box);
        dropped += kept ? 0 : 1;
        for (int k = 0; k < 200; ++k) {
            const Vec3 p = {
                random.number(box.min.x, box.max.x), random.number(box.min.y, box.max.y),
                random.number(box.min.z, box.max.z)};
            const float d = glm::length(p);
            if (d <= range.radius && glm::dot(p, axis) >= range.cosine * d) {
                REQUIRE(kept);
            }
        }
    }
    CHECK(dropped > 100);
    CHECK_FALSE(
        reaches_box({{0, 0, 0}, 5, {0, 0, -1}, 0.9f}, {{-0.2f, -0.2f, 2}, {0.2f, 0.2f, 2.4f}}));
}

}  // namespace limn::light_bounds_test
