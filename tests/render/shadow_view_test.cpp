#include "render/geometry/culling.h"
#include "render/shadow/shadow_view.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <random>

namespace limn::shadow_view_test {
namespace {

/// Of a point: texel x, texel y, depth, and q.
Vec4 project(const layout::ShadowViewRecord& record, const Vec3& p) {
    const Vec4 point = {p, 1};
    const float q = glm::dot(record.row_q, point);
    return {
        glm::dot(record.row_s, point) / q, glm::dot(record.row_t, point) / q,
        glm::dot(record.row_r, point) / q, q};
}

constexpr AtlasRect kPlace = {256, 512, 128};

layout::ShadowViewRecord record_of(const ShadowView& view) {
    return make_shadow_record(view, kPlace, 0, 0.1f, 1);
}

Vec3 random_point(std::mt19937& random, float extent) {
    std::uniform_real_distribution<float> along(-extent, extent);
    return {along(random), along(random), along(random)};
}

}  // namespace

TEST_CASE(
    "shadow view: clip space maps to the view's square of the atlas, corner by corner"
    * technique("shadow.projective-matrix")) {
    ShadowView view;
    view.resolution = 128;
    const layout::ShadowViewRecord record = record_of(view);  // clip_from_world is the identity
    CHECK(project(record, {-1, -1, 0}) == Vec4(256, 512, 0, 1));
    CHECK(project(record, {1, 1, 1}) == Vec4(384, 640, 1, 1));
    CHECK(project(record, {0, 0, 0.5f}) == Vec4(320, 576, 0.5f, 1));
}

TEST_CASE(
    "shadow view: a point on the light's axis is at the center, with depth near / distance"
    * technique("shadow.projective-matrix")) {
    const Vec3 eye = {1, 2, 3};
    const Vec3 axis = glm::normalize(Vec3(0.3f, -0.8f, 0.2f));
    const auto record = record_of(make_spot_view(eye, axis, radians(30.0f), 0.1f, 128, 2));
    for (const float distance : {0.1f, 1.0f, 7.0f, 100.0f}) {
        const Vec4 at = project(record, eye + distance * axis);
        CHECK(at.x == test::near(320).epsilon(1e-4));
        CHECK(at.y == test::near(576).epsilon(1e-4));
        CHECK(at.z == test::near(0.1 / distance).epsilon(1e-4));  // 1 at near, 0 infinitely far
        CHECK(at.w == test::near(distance).epsilon(1e-4));
    }
    CHECK(project(record, eye - axis).w < 0);  // behind the light: no projection
}

TEST_CASE("shadow view: all that a spot lights is inside its square, with a border") {
    const float angle = radians(30.0f);
    const auto record = record_of(make_spot_view({0, 0, 0}, {0, 0, -1}, angle, 0.1f, 128, 4));
    for (int i = 0; i < 16; ++i) {
        const float turn = 2 * kPi * static_cast<float>(i) / 16;
        const Vec4 at = project(
            record, {std::tan(angle) * std::cos(turn), std::tan(angle) * std::sin(turn), -1});
        CHECK(glm::distance(Vec2(at), Vec2(320, 576)) == test::near(60).epsilon(1e-4));
    }
}

TEST_CASE("shadow view: a spot's rows follow its rotation, perpendicular to its axis") {
    const Vec3 axis = glm::normalize(Vec3(0.3f, -0.8f, 0.2f));
    const auto moved = [&](const Vec3& right, const Vec3& by) {
        const auto record =
            record_of(make_spot_view({1, 2, 3}, axis, radians(30.0f), 0.1f, 128, 2, right));
        return Vec2(project(record, Vec3(1, 2, 3) + 2.0f * axis + by)) - Vec2(320, 576);
    };
    for (const Vec3& right : {Vec3(1, 0, 0), Vec3(0, 3, 1), Vec3(-1, 0.1f, 1)}) {
        const Vec3 across = right - axis * glm::dot(axis, right);
        CHECK(moved(right, across).x > 1);
        CHECK(moved(right, across).y == test::near(0).scale(1).epsilon(1e-3));
    }
    // Without a preferred direction, any will do.
    for (const Vec3& right : {Vec3(0, 0, 0), axis}) {
        CHECK(glm::length(moved(right, {0.1f, 0, 0.1f})) > 1);
    }
}

TEST_CASE(
    "shadow view: the map is linear before the division" * technique("shadow.projective-matrix")) {
    std::mt19937 random(1);
    const auto record =
        record_of(make_spot_view({1, 0, 2}, {0, -1, 0}, radians(40.0f), 0.05f, 128, 2));
    for (int i = 0; i < 20; ++i) {
        const Vec3 a = random_point(random, 3);
        const Vec3 b = random_point(random, 3);
        for (const Vec4& row : {record.row_s, record.row_t, record.row_r, record.row_q}) {
            const float midpoint = glm::dot(row, Vec4(0.5f * (a + b), 1));
            CHECK(
                midpoint
                == test::near(0.5f * (glm::dot(row, Vec4(a, 1)) + glm::dot(row, Vec4(b, 1))))
                       .epsilon(1e-3));
        }
    }
}

TEST_CASE("shadow view: a plane's slope matches differences between its points") {
    std::mt19937 random(2);
    const RenderView camera =
        make_render_view({}, look_at({0, 2, 5}, {0, 0, 0}), look_at({0, 2, 5}, {0, 0, 0}));
    for (const ShadowView& view :
         {make_spot_view({1, 4, 2}, {0, -1, 0}, radians(40.0f), 0.05f, 128, 2),
          make_cube_view({1, 4, 2}, 3, 0.05f, 128, 2),
          make_cascade_view(camera, glm::normalize(Vec3(1, 2, 0.5f)), 0, 20, 128, 2)}) {
        const auto record = record_of(view);
        const Vec3 normal = glm::normalize(Vec3(0.2f, 1, -0.3f));
        const Vec3 tangent = any_perpendicular(normal);
        const Vec3 bitangent = glm::cross(normal, tangent);
        const Vec3 p = {0.5f, 0.2f, 1};
        const Vec4 plane = {normal, -glm::dot(normal, p)};
        const Vec3 in_shadow = {
            glm::dot(record.plane_s, plane), glm::dot(record.plane_t, plane),
            glm::dot(record.plane_r, plane)};
        const Vec4 here = project(record, p);
        for (const Vec3& step : {tangent, bitangent, tangent - bitangent}) {
            const Vec4 there = project(record, p + 0.3f * step);
            const float predicted =
                here.z
                - (in_shadow.x * (there.x - here.x) + in_shadow.y * (there.y - here.y))
                      / in_shadow.z;
            CHECK(predicted == test::near(there.z).epsilon(2e-3));
        }
    }
}

TEST_CASE(
    "shadow view: six faces cover every direction, with a border each"
    * technique("shadow.map-omni")) {
    std::mt19937 random(3);
    std::array<layout::ShadowViewRecord, 6> faces;
    for (int face = 0; face < 6; ++face) {
        faces[static_cast<std::size_t>(face)] =
            record_of(make_cube_view({1, 2, 3}, face, 0.1f, 128, 4));
    }
    for (int i = 0; i < 2000; ++i) {
        const Vec3 d = random_point(random, 1);
        int owners = 0;
        for (int face = 0; face < 6; ++face) {
            const Vec4 at = project(faces[static_cast<std::size_t>(face)], Vec3(1, 2, 3) + d);
            const bool inside =
                at.w > 0 && std::abs(at.x - 320) <= 60.001f && std::abs(at.y - 576) <= 60.001f;
            owners += inside ? 1 : 0;
            if (inside) {
                // The depth is that of the major axis.
                const float m = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
                CHECK(at.z == test::near(0.1 / m).epsilon(1e-3));
            }
        }
        CHECK(owners == 1);
    }
}

TEST_CASE(
    "shadow view: a face's depth converts to the book's, with a far plane on the major axis"
    * technique("shadow.map-omni")) {
    // z_w = f / (f - n) (1 - n / m), of which ours is n / m: no far plane, and finest where far.
    const double near = 0.1;
    const double far = 100;
    const auto record = record_of(make_cube_view({0, 0, 0}, 0, 0.1f, 128, 4));
    const auto book = [&](double m) {
        const double ours =
            project(record, {static_cast<float>(m), 0.3f * static_cast<float>(m), 0}).z;
        return far / (far - near) * (1 - ours);
    };
    CHECK(book(0.1) == test::near(0).scale(1).epsilon(1e-5));
    CHECK(book(1) == test::near(0.900901).epsilon(1e-5));
    CHECK(book(10) == test::near(0.990991).epsilon(1e-5));
    CHECK(book(100) == test::near(1).epsilon(1e-5));
}

TEST_CASE(
    "shadow view: cascades cover the distance without a gap, near ones are shorter"
    * technique("shadow.map-aliasing")) {
    for (int count = 1; count <= kMaxCascades; ++count) {
        const auto ends = split_cascades(0.5f, 60, count);
        float begin = 0.5f;
        float length = 0;
        for (int i = 0; i < count; ++i) {
            const float end = ends[static_cast<std::size_t>(i)];
            CHECK(end > begin);
            CHECK(end - begin >= length);
            length = end - begin;
            begin = end;
        }
        CHECK(begin == test::near(60));
        for (int i = count; i < kMaxCascades; ++i) {
            CHECK(std::isinf(ends[static_cast<std::size_t>(i)]));
        }
    }
}

TEST_CASE("shadow view: a cascade contains all of its slice of the camera's view") {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int round = 0; round < 40; ++round) {
        const Affine pose = look_at(random_point(random, 20), random_point(random, 20));
        const RenderView camera = make_render_view({}, pose, pose, {.width = 320, .height = 180});
        const Vec3 sun = normalize_or(random_point(random, 1), {0, 1, 0});
        const auto record = record_of(make_cascade_view(camera, sun, 2, 9, 128, 2));
        for (int i = 0; i < 50; ++i) {
            const float z = 2 + 7 * unit(random);
            const Vec3 in_view = {
                (2 * unit(random) - 1) * camera.tangent.x * z,
                (2 * unit(random) - 1) * camera.tangent.y * z, -z};
            const Vec4 at = project(record, transform_point(pose, in_view));
            CHECK(std::abs(at.x - 320) <= 63.5f);
            CHECK(std::abs(at.y - 576) <= 63.5f);
            CHECK(at.z > 0);
            CHECK(at.z < 1);
        }
    }
}

TEST_CASE("shadow view: casters into a slice are inside its planes, others mostly outside") {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto inside = [](const Frustum& planes, const Vec3& p) {
        for (const Vec4& plane : planes.planes) {
            if (glm::dot(Vec3(plane), p) + plane.w < 0) {
                return false;
            }
        }
        return true;
    };
    int shading = 0;
    int others = 0;
    int others_out = 0;
    for (int view = 0; view < 200; ++view) {
        RenderView camera;
        camera.width = 160;
        camera.height = 90;
        camera.tangent = {0.64f, 0.36f};
        const Quat turn = glm::normalize(
            Quat(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f, unit(random)));
        const Vec3 eye = random_point(random, 20);
        camera.world_from_camera = affine_from(eye, turn, Vec3(1));
        const Vec3 to_sun = glm::normalize(random_point(random, 1) + Vec3(0, 0.1f, 0));
        const float near = view % 2 == 0 ? 0.0f : 8.0f;
        const float far = 20;
        const Frustum planes = shading_planes(camera, to_sun, near, far, 0.01);
        const auto in_view = [&](const Vec3& p) {
            const Vec3 local = glm::conjugate(turn) * (p - eye);
            const float depth = -local.z;
            return depth >= near && depth <= far && std::abs(local.x) <= 0.64f * depth
                   && std::abs(local.y) <= 0.36f * depth;
        };
        for (int i = 0; i < 100; ++i) {
            const float depth = near + (far - near) * unit(random);
            const Vec3 local = {
                0.64f * depth * (2 * unit(random) - 1), 0.36f * depth * (2 * unit(random) - 1),
                -depth};
            const Vec3 caster = eye + turn * local + 60 * unit(random) * to_sun;
            CHECK(inside(planes, caster));
            ++shading;
        }
        // Beside the slice, as far from it as the ball around it: shaded along a line through it?
        for (int i = 0; i < 100; ++i) {
            const Vec3 caster = eye + turn * Vec3(0, 0, -14) + random_point(random, 20);
            bool shades = false;
            for (int step = 0; step < 400 && !shades; ++step) {
                shades = in_view(caster - 0.2f * static_cast<float>(step) * to_sun);
            }
            const bool before = glm::dot(caster - (eye + turn * Vec3(0, 0, -14)), to_sun) > 0;
            if (!shades && before) {
                ++others;
                others_out += inside(planes, caster) ? 0 : 1;
            }
        }
    }
    CHECK(shading == 20000);
    CHECK(others > 1000);
    CHECK(others_out > 0.85 * others);
}

TEST_CASE("shadow view: a cascade's texels stay in place when the camera moves and turns") {
    std::mt19937 random(5);
    const Vec3 sun = glm::normalize(Vec3(0.4f, 1, 0.3f));
    const Vec3 ground = {3, 0, -2};
    double first_s = -1;
    double first_t = -1;
    for (int i = 0; i < 50; ++i) {
        const Affine pose =
            look_at(Vec3(0, 2, 8) + random_point(random, 0.3f), random_point(random, 1));
        const RenderView camera = make_render_view({}, pose, pose);
        const Vec4 at =
            project(record_of(make_cascade_view(camera, sun, 0.1f, 15, 128, 2)), ground);
        const double s = at.x - std::floor(at.x);
        const double t = at.y - std::floor(at.y);
        if (i == 0) {
            first_s = s;
            first_t = t;
        }
        CHECK(s == test::near(first_s).epsilon(0.01));
        CHECK(t == test::near(first_t).epsilon(0.01));
    }
}

TEST_CASE(
    "shadow view: twice the resolution is four times the texels per pixel"
    * technique("shadow.map-aliasing")) {
    // Lamp and camera at one position, with one field of view: a texel per pixel, and what the
    // ratio of the sizes makes of it.
    const Affine pose = look_at({1, 2, 3}, {1, 2, 0});
    const RenderView camera =
        make_render_view({.fov_y = radians(60.0f)}, pose, pose, {.width = 256, .height = 256});
    std::mt19937 random(8);
    for (const int resolution : {128, 256, 1024}) {
        const ShadowView lamp =
            make_spot_view({1, 2, 3}, {0, 0, -1}, radians(30.0f), 0.1f, resolution, 0);
        const double ratio = resolution / 256.0;
        CHECK(
            texels_per_pixel(lamp, camera, {1, 2, -4}, {0, 0, 1})
            == test::near(ratio * ratio).epsilon(1e-5));
        // From one position they have the same view, however the surface is inclined.
        for (int i = 0; i < 20; ++i) {
            const Vec3 point = Vec3(1, 2, -3) + random_point(random, 1.5f);
            const Vec3 normal = glm::normalize(Vec3(0, 0, 3) + random_point(random, 1.5f));
            CHECK(
                texels_per_pixel(lamp, camera, point, normal)
                == test::near(ratio * ratio).epsilon(1e-4));
        }
    }
    // From elsewhere, against the texels of the pixel's corners on the surface.
    const ShadowView lamp = make_spot_view(
        {4, 5, -1}, glm::normalize(Vec3(-1, -1, -0.5f)), radians(50.0f), 0.1f, 512, 4);
    const layout::ShadowViewRecord record = make_shadow_record(lamp, {0, 0, 512}, 0, 0, 1);
    const float step = 2 * std::tan(radians(30.0f)) / 256;
    const auto texel = [&](float x, float y) {  // of the floor y = 0, right of and above the center
        const Vec3 ray = {0.2f + x * step, -0.7f + y * step, -1};
        return Vec2(project(record, Vec3(1, 2, 3) + ray * (2 / -ray.y)));
    };
    const Vec2 right = texel(0.5f, 0) - texel(-0.5f, 0);
    const Vec2 up = texel(0, 0.5f) - texel(0, -0.5f);
    const Vec3 midpoint = Vec3(1, 2, 3) + Vec3(0.2f, -0.7f, -1) * (2 / 0.7f);
    CHECK(
        texels_per_pixel(lamp, camera, midpoint, {0, 1, 0})
        == test::near(std::abs(right.x * up.y - right.y * up.x)).epsilon(0.01));
}

TEST_CASE("culling: a box is kept if the light's sphere touches it (shadow.caster-cull)") {
    const Bounds box = {{2, 2, 2}, {3, 3, 3}};
    CHECK_FALSE(sphere_touches({0, 0, 0}, 3.4f, box));  // 11.56 < 12
    CHECK(sphere_touches({0, 0, 0}, 3.5f, box));        // 12.25 > 12
    CHECK(sphere_touches({2.5f, 2.5f, 2.5f}, 0, box));
    CHECK(sphere_touches({100, 0, 0}, INFINITY, box));
}

}  // namespace limn::shadow_view_test
