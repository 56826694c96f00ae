#include "render/shadow/perspective_view.h"
#include "render/shadow/shadow_list.h"
#include "tests/near.h"
#include "tests/render/shadow_fixture.h"
#include "tests/technique.h"

#include <glm/matrix.hpp>

#include <random>

namespace limn::test::perspective_view_test {
namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec4;
using oracle::DVec3;

/// Of a position: x and y in the image and depth; w is q.
dvec4 project(const dmat4& clip_from_world, const DVec3& p) {
    const dvec4 clip = clip_from_world * dvec4(p, 1);
    return {DVec3(clip) / clip.w, clip.w};
}

/// In the origin, looking along -z.
RenderView straight_view(float fov_deg = 90) {
    return make_render_view(
        {.fov_y = radians(fov_deg), .near = 0.1f}, at({0, 0, 0}), at({0, 0, 0}), {64, 64});
}

DVec3 random_in(std::mt19937& random, double low, double high) {
    std::uniform_real_distribution<double> along(low, high);
    const double x = along(random);
    const double y = along(random);
    return {x, y, along(random)};
}

/// Lights of all kinds about a camera that looks along -z: homogeneous, none in the image.
const std::vector<Vec4>& lights_about() {
    static const std::vector<Vec4> lights = {
        {0, 1, 0, 0},                                    // above
        {0.5f, 0.6f, 0.1f, 0},                           // from the side and a little behind
        {0.5f, 0.6f, -0.1f, 0}, {0.1f, 0.5f, -0.9f, 0},  // ahead: the worst case
        {-0.2f, 0.4f, 0.9f, 0},                          // behind
        {0, 0, 1, 0},           {0, 30, -10, 1},         // lamps
        {20, 12, 5, 1},         {-3, 4, 9, 1},          {0.5f, 15, 0, 1},
    };
    return lights;
}

}  // namespace

TEST_CASE(
    "perspective map: under a sun above, ten times nearer means ten times the texels"
    * technique("shadow.perspective-map")) {
    const RenderView camera = straight_view();
    const auto corners = slice_corners(camera, {.near = 1, .far = 100});
    const dvec4 sun = {0, 1, 0, 0};
    const auto length_at = [](const dmat4& map, double distance) {
        const dvec4 left = project(map, {-0.5, -1, -distance});
        const dvec4 right = project(map, {0.5, -1, -distance});
        return glm::distance(dvec2(left), dvec2(right));
    };
    const auto map = fit_light_view(virtual_camera(camera, 1, 100, 0), sun, corners, 1);
    REQUIRE(map);
    CHECK(length_at(*map, 2) / length_at(*map, 20) == test::near(10).epsilon(1e-9));
    const auto uniform = fit_light_view(dmat4(1), sun, corners, 1);
    REQUIRE(uniform);
    CHECK(length_at(*uniform, 2) / length_at(*uniform, 20) == test::near(1).epsilon(1e-9));
    // The farther behind the virtual camera stands, the less it distorts.
    const auto tempered = fit_light_view(virtual_camera(camera, 1, 100, 8), sun, corners, 1);
    REQUIRE(tempered);
    CHECK(length_at(*tempered, 2) / length_at(*tempered, 20) == test::near(28.0 / 10));
}

TEST_CASE(
    "perspective map: a sun maps to a point at depth 1.020202, a lateral one to a direction"
    * technique("shadow.perspective-map")) {
    const dmat4 camera = virtual_camera(straight_view(), 1, 100, 0);
    for (const DVec3& toward : {DVec3(0.3, 0.5, -0.6), DVec3(0, 0, -1), DVec3(-1, 2, 0.7)}) {
        const dvec4 light = camera * dvec4(toward, 0);
        CHECK(light.z / light.w == test::near(101.0 / 99).epsilon(1e-12));
        CHECK((light.w > 0) == (toward.z < 0));  // behind the camera its w is negative
    }
    CHECK((camera * dvec4(1, 1, 0, 0)).w == 0);
    // The book's depths: -1 at near, 1 at far.
    CHECK(project(camera, {0, 0, -1}).z == test::near(-1));
    CHECK(project(camera, {0, 0, -100}).z == test::near(1));
}

TEST_CASE(
    "perspective map: for an orthographic camera it is an ordinary shadow map"
    * technique("shadow.perspective-map")) {
    const RenderView camera = straight_view();
    const auto corners = slice_corners(camera, {.near = 1, .far = 20});
    dmat4 orthographic(1);
    orthographic[0][0] = orthographic[1][1] = 0.05;
    orthographic[2][2] = -0.1;
    orthographic[3][2] = -1;
    std::mt19937 random(1);
    for (const Vec4& light : lights_about()) {
        if (light.w != 0) {
            continue;
        }
        const auto map = fit_light_view(orthographic, dvec4(light), corners, 1);
        REQUIRE(map);
        // Its w is the same everywhere, its depth grows toward the sun and is the same across.
        CHECK(glm::transpose(*map)[3] == dvec4(0, 0, 0, 1));
        const DVec3 toward = glm::normalize(DVec3(light));
        const double rise = glm::dot(DVec3(glm::transpose(*map)[2]), toward);
        CHECK(rise > 0);
        for (int i = 0; i < 50; ++i) {
            const DVec3 p = random_in(random, -20, 20);
            const dvec4 here = project(*map, p);
            const dvec4 there = project(*map, p + 3.0 * toward);
            CHECK(glm::distance(dvec2(here), dvec2(there)) < 1e-9);
            CHECK(there.z - here.z == test::near(3 * rise).epsilon(1e-9));
        }
    }
}

TEST_CASE(
    "perspective map: a light ray maps to one texel, and depth is monotonic along it"
    * technique("shadow.perspective-map")) {
    const RenderView camera = straight_view();
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const Vec4& light : lights_about()) {
        const ViewSlice slice = {.near = 0.1, .far = 30};
        const auto view = make_perspective_view(camera, light, slice, 512, 2);
        CAPTURE(light.x);
        CAPTURE(light.z);
        REQUIRE(view);
        const dmat4 map(view->clip_from_world);
        for (int i = 0; i < 200; ++i) {
            const double along = 0.1 + 29.9 * unit(random);
            const DVec3 p = {
                (2 * unit(random) - 1) * along, (2 * unit(random) - 1) * along, -along};
            const dvec4 here = project(map, p);
            CHECK(here.w > 0);
            CHECK(std::max(std::abs(here.x), std::abs(here.y)) <= 508.0 / 512 + 1e-4);
            CHECK(here.z > 0);
            CHECK(here.z <= 1 + 1e-4);
            // Also where the ray passes the plane of the camera.
            double last = here.z;
            for (int k = 1; k < 10; ++k) {
                const DVec3 nearer = light.w == 0 ? p + 0.5 * k * k * glm::normalize(DVec3(light))
                                                  : glm::mix(p, DVec3(light), 0.1 * k);
                const dvec4 there = project(map, nearer);
                CHECK(there.w > 0);
                CHECK(glm::distance(dvec2(here), dvec2(there)) < 2e-3);
                CHECK(there.z > last - 1e-6);
                last = there.z;
            }
        }
    }
}

TEST_CASE("perspective map: a light inside the view, or an empty slice, has no map") {
    const RenderView camera = straight_view();
    const ViewSlice slice = {.near = 0.1, .far = 30};
    CHECK_FALSE(make_perspective_view(camera, {0, 0, -5, 1}, slice, 512, 2));
    CHECK_FALSE(make_perspective_view(camera, {2, -3, -20, 1}, slice, 512, 2));
    CHECK_FALSE(make_perspective_view(camera, {0, 9, 0, 1}, {.near = 3, .far = 3}, 512, 2));
    CHECK_FALSE(make_perspective_view(camera, {0, 9, 0, 1}, {.near = 0, .far = 3}, 512, 2));
    const float nan = std::nanf("");
    CHECK_FALSE(make_perspective_view(camera, {nan, 9, 0, 1}, slice, 512, 2));
}

TEST_CASE(
    "perspective map: near the camera it has more texels than a uniform map of its size"
    * technique("shadow.map-aliasing")) {
    const Affine pose = look_at({0, 1.7f, 0}, {0, 1.2f, -5});
    const RenderView camera =
        make_render_view({.fov_y = radians(60.0f)}, pose, pose, {.width = 640, .height = 360});
    const Vec3 sun = glm::normalize(Vec3(0.6f, 1, 0.1f));
    const auto perspective = make_perspective_view(
        camera, Vec4(sun, 0),
        {.near = 0.1, .far = 40, .low = -camera.tangent, .high = camera.tangent}, 1024, 4);
    REQUIRE(perspective);
    const ShadowView uniform = make_cascade_view(camera, sun, 0, 40, 1024, 4);
    const auto gain = [&](float distance) {
        const Vec3 floor = {0, 0, -distance};
        return texels_per_pixel(*perspective, camera, floor, {0, 1, 0})
               / texels_per_pixel(uniform, camera, floor, {0, 1, 0});
    };
    CHECK(gain(4) > 20);
    CHECK(gain(10) > 4);
    CHECK(gain(4) > gain(10));
    CHECK(gain(10) > gain(30));
}

namespace {

/// Posts on a floor, some behind the camera.
struct PostScene : ShadowTest {
    PostScene() {
        put(make_plane({.size = {60, 60}}), {0, 0, 0});
        const MeshId post = add(make_box({.size = {0.4f, 1.6f, 0.4f}}));
        for (int i = 0; i < 15; ++i) {
            place(
                post, white,
                at({static_cast<float>(i % 3) * 3 - 3, 0.8f, 6 - 3 * static_cast<float>(i / 3)}));
        }
    }
    [[nodiscard]] RenderView view() const { return look({0.5f, 2.5f, 4}, {0, 0.5f, -3}, 96, 96); }
    int shadow_views() { return draw(view()).statistics.shadow_views; }
};

constexpr Shadow kPerspective = {
    .method = ShadowMethod::Perspective,
    .filter = ShadowFilter::Hard,
    .resolution = 1024,
    .distance = 25};

}  // namespace

TEST_CASE_FIXTURE(
    PostScene, "perspective map: shadows of suns in all directions match ray casts, with one map"
                   * technique("shadow.perspective-map")) {
    const oracle::ShadowScene rays(world);
    for (const Vec3& toward :
         {Vec3(0.1f, 1, 0.05f), Vec3(0.7f, 0.9f, 0.4f), Vec3(0.2f, 0.5f, -0.8f),  // into the camera
          Vec3(-0.1f, 0.35f, 0.9f)}) {  // from behind: the posts there shadow the visible ground
        const DVec3 to_sun = glm::normalize(DVec3(toward));
        const Entity sun = shine(DirectionalLight{}, look_at(toward, {0, 0, 0}));
        world.add(sun, kPerspective);
        CAPTURE(toward.z);
        CHECK(shadow_views() == 1);
        const auto all = receivers(sun, view());
        const auto blocked = [&](const DVec3& p) {
            const double along =
                glm::dot(p - DVec3(0.5, 2.5, 4), glm::normalize(DVec3(-0.5, -2, -7)));
            return along < 24 && rays.blocked_toward(p, to_sun);
        };
        CHECK(agreement(all, blocked) >= 0.98);
        const WrongPixels wrong = wrong_pixels(
            all, 0.15, [&](const DVec3&) { return to_sun; }, blocked);
        CHECK(wrong.acne == 0);
        CHECK(wrong.floating == 0);
        world.destroy(sun);
    }
}

TEST_CASE_FIXTURE(
    PostScene, "perspective map: away from edges it agrees with the uniform map"
                   * technique("shadow.perspective-map")) {
    const Entity sun = shine(DirectionalLight{}, look_at({0.7f, 0.9f, 0.4f}, {0, 0, 0}));
    world.add(sun, kPerspective);
    const auto distorted = receivers(sun, view());
    Shadow uniform = kPerspective;
    uniform.method = ShadowMethod::Map;
    uniform.cascades = 1;
    world.add(sun, uniform);
    const auto straight = receivers(sun, view());
    int compared = 0;
    int different = 0;
    for (int y = 2; y < 94; ++y) {
        for (int x = 2; x < 94; ++x) {
            const auto at = [&](int dx, int dy) {
                return static_cast<std::size_t>((y + dy) * 96 + x + dx);
            };
            const Receiver& here = straight[at(0, 0)];
            bool edge = !here.valid;
            for (int i = 0; i < 25; ++i) {
                const Receiver& there = straight[at(i % 5 - 2, i / 5 - 2)];
                edge = edge || !there.valid || there.visibility != here.visibility;
            }
            if (!edge) {
                ++compared;
                different +=
                    (distorted[at(0, 0)].visibility < 0.5) != (here.visibility < 0.5) ? 1 : 0;
            }
        }
    }
    CHECK(compared > 3000);
    CHECK(different == 0);
}

TEST_CASE_FIXTURE(
    PostScene,
    "perspective map: a lamp outside the view has one map, one inside it the usual six") {
    const oracle::ShadowScene rays(world);
    const Entity lamp = shine(PointLight{.radius = 0}, at({0, 0, 0}));
    world.add(lamp, kPerspective);
    for (const Vec3& position : {Vec3(1.5f, 7, 1), Vec3(-2, 3, 9), Vec3(0, 1, -4)}) {
        world.get<WorldTransform>(lamp).world = at(position);
        CAPTURE(position.z);
        CHECK(shadow_views() == (position.z < 0 ? 6 : 1));
        CHECK(
            agreement(
                receivers(lamp, view()),
                [&](const DVec3& p) { return rays.blocked(p, DVec3(position)); })
            >= 0.98);
    }
}

TEST_CASE_FIXTURE(PostScene, "perspective map: a spot's map covers only what it lights") {
    const oracle::ShadowScene rays(world);
    const Vec3 position = {3, 6, 1};
    const Entity lamp = shine(
        SpotLight{
            .radius = 12,
            .attenuation = {.falloff = Falloff::None},
            .inner_angle = radians(25.0f),
            .outer_angle = radians(25.0f)},
        look_at(position, {0.5f, 0, -3}));
    world.add(lamp, kPerspective);
    CHECK(shadow_views() == 1);
    CHECK(
        agreement(
            receivers(lamp, view()),
            [&](const DVec3& p) { return rays.blocked(p, DVec3(position)); })
        >= 0.98);
}

TEST_CASE("perspective map: contact hardening falls back to the soft filter") {
    const Shadow asked = {
        .method = ShadowMethod::Perspective, .filter = ShadowFilter::ContactHardening};
    CHECK(sanitize(asked).filter == ShadowFilter::Soft);
}

}  // namespace limn::test::perspective_view_test
