#include "render/geometry/culling.h"
#include "render/render_view.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <memory>
#include <random>

namespace limn::test::culling_test {
namespace {

constexpr int kBoxes = 100 * kCullBlock;

RenderView random_view(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const Vec3 eye = {20 * unit(random), 20 * unit(random), 20 * unit(random)};
    const Affine pose = look_at(eye, {20 * unit(random), 20 * unit(random), 20 * unit(random)});
    const float fov = radians(60 + 50 * unit(random));
    return make_render_view(
        {.fov_y = fov, .near = 0.1f}, pose, pose, {.width = 320, .height = 200});
}

Bounds random_box(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const Vec3 c = {30 * unit(random), 30 * unit(random), 30 * unit(random)};
    const float size = std::exp2(4 * unit(random) - 1);
    const Vec3 h = size * Vec3(1.01f + unit(random), 1.01f + unit(random), 1.01f + unit(random));
    return {c - h, c + h};
}

void put(BoxBlock& block, int i, const Bounds& box) {
    const Vec3 c = center(box);
    const Vec3 h = half_extent(box);
    block.set(i, c, h);
}

bool in_picture(const RenderView& view, const Vec3& p) {
    const Vec4 clip = view.clip_from_world * Vec4(p, 1);
    return std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w && clip.z <= clip.w;
}

}  // namespace

TEST_CASE("culling: the kernel agrees with the scalar version in 1e5 random boxes") {
    std::mt19937 random(7);
    const auto block = std::make_unique<BoxBlock>();
    std::uint8_t fast[kCullBlock];
    std::uint8_t slow[kCullBlock];
    int visible = 0;
    for (int b = 0; b < kBoxes / kCullBlock; ++b) {
        const int count = b == 0 ? 1 : b == 1 ? 13 : kCullBlock;  // odd lengths as well
        for (int i = 0; i < count; ++i) {
            put(*block, i, random_box(random));
        }
        const Frustum frustum = make_frustum(random_view(random).clip_from_world);
        cull_boxes(frustum, *block, count, fast);
        cull_boxes_scalar(frustum, *block, count, slow);
        for (int i = 0; i < count; ++i) {
            REQUIRE(fast[i] == slow[i]);
            visible += fast[i];
        }
    }
    CHECK(visible > kBoxes / 100);
    CHECK(visible < kBoxes / 2);
}

TEST_CASE(
    "culling: no box with a point in the image is lost, in 1e5 random boxes"
    * technique("fakephong.pipeline")) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto block = std::make_unique<BoxBlock>();
    std::uint8_t visible[kCullBlock];
    Bounds boxes[kCullBlock];
    int seen = 0;
    for (int b = 0; b < kBoxes / kCullBlock; ++b) {
        const RenderView view = random_view(random);
        for (int i = 0; i < kCullBlock; ++i) {
            boxes[i] = random_box(random);
            put(*block, i, boxes[i]);
        }
        cull_boxes(make_frustum(view.clip_from_world), *block, kCullBlock, visible);
        for (int i = 0; i < kCullBlock; ++i) {
            for (int k = 0; k < 12; ++k) {
                const Vec3 t = {unit(random), unit(random), unit(random)};
                const Vec3 p = glm::mix(boxes[i].min, boxes[i].max, k < 8 ? glm::round(t) : t);
                if (in_picture(view, p)) {
                    REQUIRE(visible[i] == 1);
                    ++seen;
                }
            }
        }
    }
    CHECK(seen > 1000);
}

TEST_CASE(
    "culling: boxes behind, above or beside the camera are culled"
    * technique("fakephong.pipeline")) {
    const Affine pose = look_at({0, 0, 5}, {0, 0, 0});
    const RenderView view =
        make_render_view({.near = 0.1f}, pose, pose, {.width = 64, .height = 64});
    const Frustum frustum = make_frustum(view.clip_from_world);
    const auto block = std::make_unique<BoxBlock>();
    const Vec3 unit = Vec3(0.5f);
    const Vec3 centers[] = {{0, 0, 0},   {0, 0, -1e6f}, {0, 0, 6},  {0, 20, 0},
                            {0, -20, 0}, {20, 0, 0},    {-20, 0, 0}};
    for (int i = 0; i < 7; ++i) {
        put(*block, i, {centers[i] - unit, centers[i] + unit});
    }
    std::uint8_t visible[7];
    cull_boxes(frustum, *block, 7, visible);
    CHECK(visible[0] == 1);
    CHECK(visible[1] == 1);  // there is no far plane
    for (int i = 2; i < 7; ++i) {
        CHECK(visible[i] == 0);
    }
    // Before the eye, but nearer than the near plane.
    const RenderView far_near =
        make_render_view({.near = 4.0f}, pose, pose, {.width = 64, .height = 64});
    cull_boxes(make_frustum(far_near.clip_from_world), *block, 1, visible);
    CHECK(visible[0] == 1);
    put(*block, 0, {Vec3(0, 0, 2) - unit, Vec3(0, 0, 2) + unit});
    cull_boxes(make_frustum(far_near.clip_from_world), *block, 1, visible);
    CHECK(visible[0] == 0);
}

TEST_CASE("culling: a transformed box contains every transformed corner, tightly if only scaled") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int n = 0; n < 1000; ++n) {
        const Bounds box = random_box(random);
        const Quat rotation =
            glm::normalize(Quat(unit(random), unit(random), unit(random), unit(random)));
        const Affine a = affine_from(
            {unit(random), unit(random), unit(random)}, n % 2 == 0 ? rotation : Quat(1, 0, 0, 0),
            {3 * unit(random), 0.1f, -2});
        const Bounds moved = transform_bounds(a, box);
        Bounds tight;
        for (int k = 0; k < 8; ++k) {
            const Vec3 t = {k & 1, k >> 1 & 1, k >> 2};
            grow(tight, transform_point(a, glm::mix(box.min, box.max, t)));
        }
        const float slack = 1e-4f * (1 + glm::length(moved.max));
        for (int i = 0; i < 3; ++i) {
            CHECK(moved.min[i] <= tight.min[i] + slack);
            CHECK(moved.max[i] >= tight.max[i] - slack);
            CHECK(std::abs(moved.min[i] - tight.min[i]) <= slack);
        }
    }
}

}  // namespace limn::test::culling_test
