// Relief boxes against the meshes that their maps were made of.

#include "content/make/models/shapes.h"
#include "content/make/patterns/solid_pattern.h"
#include "ecs/components/relief_box.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn::test::relief_box_drawing_test {
namespace {

constexpr int kSize = 128;
constexpr Vec3 kEyes[] = {{0.2f, 0.1f, 2.2f}, {1.5f, 1.1f, 1.2f}, {-1.9f, -0.6f, -0.8f}};

/// The sides of a box in the order of its fields.
constexpr SolidSide kOrder[] = {SolidSide::Front, SolidSide::Back, SolidSide::Left,
                                SolidSide::Right, SolidSide::Top,  SolidSide::Bottom};

ImageData flat_map(std::uint8_t front, std::uint8_t back = 255) {
    return {.name = "flat", .width = 1, .height = 1, .pixels = {128, 128, back, front}};
}

struct BoxScene : Scene {
    [[nodiscard]] static Material stone(ImageId relief, SurfaceDetail detail) {
        Material material = {.base_color = {1, 1, 1, 1}, .roughness = 0.8f};
        material.detail = detail;
        material.relief_steps = 96;
        material.relief_refinements = 8;
        material.relief_texture = {.image = relief};
        return material;
    }
    MaterialId carved(const ImageData& relief, SurfaceDetail detail = SurfaceDetail::DoubleDepth) {
        return add(stone(add(relief), detail));
    }
    /// With the maps of a mesh: of its front, or of all sides.
    ReliefBox box_of(const MeshData& mesh, int maps = 1) {
        ReliefBox box;
        MaterialId* const sides[] = {&box.front, &box.back, &box.left,
                                     &box.right, &box.top,  &box.bottom};
        for (int i = 0; i < maps; ++i) {
            *sides[i] = carved(make_solid_relief(mesh, kOrder[i], 256));
        }
        return box;
    }
    Entity place_box(const ReliefBox& box, const Vec3& eye, const Vec3& position = Vec3(0)) {
        const Quat rotation = glm::quatLookAt(glm::normalize(-eye), Vec3(0, 1, 0));
        world.create(
            Transform{.position = eye, .rotation = rotation}, Camera{.fov_y = radians(40.0f)});
        const Entity entity = world.create(Transform{.position = position}, box);
        start_world(world);
        return entity;
    }
    [[nodiscard]] RenderView view_from(const Vec3& eye) const {
        const Affine pose = look_at(eye, {0, 0, 0});
        return make_render_view(
            {.fov_y = radians(40.0f), .near = 0.05f}, pose, pose,
            {.width = kSize, .height = kSize});
    }
    void light() {
        world.create(
            SpotLight{.intensity = 60, .radius = 0, .inner_angle = 0.5f, .outer_angle = 0.6f},
            WorldTransform{look_at({1.0f, 3.0f, 1.5f}, {0, 0, 0})}, Shadow{.resolution = 1024});
    }
};

/// Where the depth is that of something.
bool is_covered(const gpu::FloatImage& depth, int x, int y) {
    const float d = depth.at(x, y, 0);
    return d > 0 && d < 100;
}

/// Pixels of both over pixels of either.
double shared_pixels(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    int both = 0;
    int either = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            both += is_covered(a, x, y) && is_covered(b, x, y) ? 1 : 0;
            either += is_covered(a, x, y) || is_covered(b, x, y) ? 1 : 0;
        }
    }
    REQUIRE(either > 500);
    return double(both) / either;
}

/// Mean difference of depths where both have one [m].
double mean_distance(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            if (is_covered(a, x, y) && is_covered(b, x, y)) {
                sum += double(std::abs(a.at(x, y, 0) - b.at(x, y, 0)));
                ++count;
            }
        }
    }
    return sum / std::max(count, 1);
}

/// Mean length of the difference of normals where both images have a surface.
double mean_tilt(
    const gpu::FloatImage& a, const gpu::FloatImage& b, const gpu::FloatImage& depth_a,
    const gpu::FloatImage& depth_b) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            if (is_covered(depth_a, x, y) && is_covered(depth_b, x, y)) {
                sum += double(glm::length(rgb_at(a, x, y) - rgb_at(b, x, y)));
                ++count;
            }
        }
    }
    return sum / std::max(count, 1);
}

/// Fraction of the pixels whose red differs by more than `visible`.
double different_pixels(const gpu::FloatImage& a, const gpu::FloatImage& b, float visible) {
    int different = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            different += std::abs(a.at(x, y, 0) - b.at(x, y, 0)) > visible ? 1 : 0;
        }
    }
    return double(different) / (a.width * a.height);
}

}  // namespace

TEST_CASE_FIXTURE(
    BoxScene,
    "relief box: a flat relief is a block from that depth to the end of the box, with solid sides"
        * technique("relief.box, relief.planar")) {
    const float depth = 64.0f / 255;
    for (const Vec3& eye : {Vec3(0.3f, 0.2f, 3), Vec3(2, 1.2f, 1.5f), Vec3(-2, -0.9f, -2)}) {
        const RenderView view = view_from(eye);
        world.clear();
        world.insert_resource(Assets{});
        place(add(make_box({.size = {1, 1, 1 - depth}})), add(Material{}), at({0, 0, -depth / 2}));
        const gpu::FloatImage block = aov(view, "depth");
        const gpu::FloatImage normals = aov(view, "normal");
        for (const SurfaceDetail detail : {SurfaceDetail::DoubleDepth, SurfaceDetail::Relief}) {
            world.clear();
            world.insert_resource(Assets{});
            ReliefBox box;
            box.front = carved(flat_map(64), detail);
            place_box(box, eye);
            CAPTURE(eye.x);
            CAPTURE(static_cast<int>(detail));
            const gpu::FloatImage found = aov(view, "depth");
            const gpu::FloatImage found_normals = aov(view, "normal");
            CHECK(shared_pixels(found, block) >= 0.99);
            CHECK(mean_distance(found, block) <= 1e-3);
            CHECK(mean_tilt(found_normals, normals, found, block) <= 0.02);
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene, "relief box: where the map has nothing, nothing is drawn"
                  * technique("relief.box, relief.cap")) {
    for (const SurfaceDetail detail : {SurfaceDetail::DoubleDepth, SurfaceDetail::Relief}) {
        for (const ReliefSlices slices : {ReliefSlices::None, ReliefSlices::Face}) {
            world.clear();
            world.insert_resource(Assets{});
            ReliefBox box = {.slices = slices};
            box.front = carved(flat_map(255, 0), detail);
            place_box(box, {1, 1, 2});
            const gpu::FloatImage depth = aov(view_from({1, 1, 2}), "depth");
            int covered = 0;
            for (int i = 0; i < kSize * kSize; ++i) {
                covered += is_covered(depth, i % kSize, i / kSize) ? 1 : 0;
            }
            CHECK(covered == 0);
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene,
    "relief box: a ball has the outline and the depth of its mesh from everywhere, with one map or "
    "six"
        * technique("relief.multi-face, relief.double-depth")) {
    const MeshData ball = make_sphere({});
    for (const Vec3& eye : kEyes) {
        const RenderView view = view_from(eye);
        world.clear();
        world.insert_resource(Assets{});
        place(add(ball), add(Material{}), at({0, 0, 0}));
        const gpu::FloatImage expected = aov(view, "depth");
        for (const int maps : {1, 6}) {
            world.clear();
            world.insert_resource(Assets{});
            place_box(box_of(ball, maps), eye);
            const gpu::FloatImage found = aov(view, "depth");
            CAPTURE(maps);
            CAPTURE(eye.x);
            CHECK(shared_pixels(found, expected) >= 0.98);
            CHECK(mean_distance(found, expected) <= 0.006);
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene,
    "relief slices: the result is the nearest plane deeper than the surface, for both alignments"
        * technique("relief.slices, relief.slices-view")) {
    // Straight on from afar: both alignments have the same planes.
    const Vec3 eye = {0, 0, 60};
    const Affine pose = look_at(eye, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(0.4f / 60), .near = 1}, pose, pose, {.width = 16, .height = 16});
    for (const ReliefSlices slices : {ReliefSlices::Face, ReliefSlices::View}) {
        for (const int depth : {20, 64, 100, 191}) {
            world.clear();
            world.insert_resource(Assets{});
            ReliefBox box = {.slices = slices, .min_slices = 8, .max_slices = 8};
            box.front = carved(flat_map(static_cast<std::uint8_t>(depth)));
            place_box(box, eye);
            const gpu::FloatImage found = aov(view, "depth");
            const int plane = depth * 8 / 255 + 1;  // the smallest k / 8 > depth
            CAPTURE(depth);
            CHECK(found.at(8, 8, 0) - 59.5f == near(plane / 8.0).epsilon(2e-3));
        }
    }
    // Between front and back: 0.204 .. 0.796 has planes at 2/5 and 3/5, 0.204 .. 0.396 has none.
    world.clear();
    world.insert_resource(Assets{});
    ReliefBox box = {.slices = ReliefSlices::Face, .min_slices = 5, .max_slices = 5};
    box.front = carved(flat_map(52, 203));
    place_box(box, eye);
    CHECK(aov(view, "depth").at(8, 8, 0) - 59.5f == near(0.4).epsilon(2e-3));
    world.clear();
    world.insert_resource(Assets{});
    box.front = carved(flat_map(52, 101));
    place_box(box, eye);
    CHECK_FALSE(is_covered(aov(view, "depth"), 8, 8));
}

TEST_CASE_FIXTURE(
    BoxScene, "relief slices: the error of the depth is less than the distance of planes"
                  * technique("relief.slices, relief.slices-view")) {
    const MeshData ball = make_sphere({});
    const Vec3 eye = kEyes[0];
    const RenderView view = view_from(eye);
    place_box(box_of(ball), eye);
    const gpu::FloatImage searched = aov(view, "depth");
    for (const ReliefSlices slices : {ReliefSlices::Face, ReliefSlices::View}) {
        for (const int count : {16, 64, 256}) {
            world.clear();
            world.insert_resource(Assets{});
            ReliefBox box = box_of(ball);
            box.slices = slices;
            box.min_slices = count;
            box.max_slices = count;
            place_box(box, eye);
            const gpu::FloatImage found = aov(view, "depth");
            CAPTURE(static_cast<int>(slices));
            CAPTURE(count);
            CHECK(mean_distance(found, searched) <= 1.2 / count + 0.002);
            CHECK(mean_distance(found, searched) >= 0.2 / count - 0.002);
            CHECK(shared_pixels(found, searched) >= (count == 16 ? 0.9 : 0.97));
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene, "relief box: it is lit, casts its shadow and moves as the mesh does, in slices, too"
                  * technique("relief.box, relief.slices")) {
    const MeshData ball = make_sphere({});
    const Vec3 eye = {1.5f, 2.0f, 2.2f};
    const RenderView view = view_from(eye);
    const auto build = [&] {
        world.clear();
        world.insert_resource(Assets{});
        light();
        MeshData floor = make_square();
        for (Vec3& p : floor.positions) {
            p = {4 * p.x, -0.5f, -4 * p.y};
        }
        floor.normals.assign(4, {0, 1, 0});
        floor.bounds = {Vec3(-4, -0.5f, -4), Vec3(4, -0.5f, 4)};
        place(add(std::move(floor)), add(Material{.base_color = {1, 1, 1, 1}}), at({0, 0, 0}));
    };
    build();
    place(add(ball), add(Material{.base_color = {1, 1, 1, 1}, .roughness = 0.8f}), at({0, 0, 0}));
    const gpu::FloatImage expected = radiance(view);
    for (const ReliefSlices slices : {ReliefSlices::None, ReliefSlices::Face, ReliefSlices::View}) {
        build();
        ReliefBox box = box_of(ball, 6);
        box.slices = slices;
        box.min_slices = 128;
        box.max_slices = 128;
        place_box(box, eye);
        CAPTURE(static_cast<int>(slices));
        const gpu::FloatImage found = radiance(view);
        CHECK(different_pixels(found, expected, 0.15f) <= 0.02);
        if (slices == ReliefSlices::None) {
            const gpu::FloatImage deferred = radiance(view);
            for (const LightMethod method : {LightMethod::ObjectMajor, LightMethod::LightMajor}) {
                world.insert_resource(Rendering{.lights = method});
                CHECK(different_pixels(radiance(view), deferred, 2e-3f) <= 0.001);
            }
        }
    }
}

}  // namespace limn::test::relief_box_drawing_test
