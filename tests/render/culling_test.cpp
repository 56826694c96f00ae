#include "render/geometry/culling.h"
#include "render/render_view.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
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

TEST_CASE(
    "culling: blocks of boxes are culled as their boxes are one by one, with fewer tests where "
    "those "
    "lie together"
    * technique("engine.hier-bounds")) {
    std::mt19937 random(23);
    std::uniform_real_distribution<float> unit(-1, 1);
    constexpr int kClusters = 400;
    constexpr int kCluster = 200;
    const auto block = std::make_unique<BoxBlock>();
    std::uint8_t fast[kCullBlock];
    std::uint8_t slow[kCullBlock];
    int tested = 0;
    int seen[3] = {};
    for (int b = 0; b < kClusters; ++b) {
        const Vec3 middle = {40 * unit(random), 40 * unit(random), 40 * unit(random)};
        for (int i = 0; i < kCluster; ++i) {
            const Vec3 c = middle + 2.0f * Vec3(unit(random), unit(random), unit(random));
            const Vec3 h = 0.3f * Vec3(1 + unit(random), 1 + unit(random), 1 + unit(random));
            put(*block, i, {c - h, c + h});
        }
        const BlockBounds around = bounds_around(*block, kCluster);
        for (int i = 0; i < kCluster; ++i) {
            const Bounds& group = around.groups[i / kCullGroup];
            for (const Bounds* const box : {&around.all, &group}) {
                REQUIRE(glm::all(glm::lessThanEqual(box->min, block->center(i) - block->half(i))));
                REQUIRE(
                    glm::all(glm::greaterThanEqual(box->max, block->center(i) + block->half(i))));
            }
        }
        if (b == 7) {  // one that cannot be drawn
            block->set(3, Vec3(0), Vec3(-1e30f));
            const Frustum everything = {
                {{1, 0, 0, 1e4f},
                 {-1, 0, 0, 1e4f},
                 {0, 1, 0, 1e4f},
                 {0, -1, 0, 1e4f},
                 {0, 0, 1, 1e4f}}};
            cull_boxes_within(everything, bounds_around(*block, kCluster), *block, kCluster, fast);
            CHECK(fast[3] == 0);
            CHECK(fast[4] == 1);
            continue;
        }
        const Frustum frustum = make_frustum(random_view(random).clip_from_world);
        const int tests = cull_boxes_within(frustum, around, *block, kCluster, fast);
        cull_boxes_scalar(frustum, *block, kCluster, slow);
        for (int i = 0; i < kCluster; ++i) {
            REQUIRE(fast[i] == slow[i]);
        }
        const Containment all = contains(frustum, around.all);
        CHECK((tests == 1) == (all != Containment::Partly));
        CHECK(tests <= 1 + kCluster + 4);
        ++seen[static_cast<int>(all)];
        tested += tests;
    }
    CHECK(tested < kClusters * kCluster / 2);
    for (const int count : seen) {
        CHECK(count > kClusters / 50);
    }
}

TEST_CASE(
    "culling: a box at a plane is decided by its items, an empty one is in no frustum"
    * technique("engine.hier-bounds")) {
    const Frustum slab = {{{1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 1}}};
    const auto at = [](float low, float high) {
        return Bounds{Vec3(low, -1, -1), Vec3(high, 1, 1)};
    };
    CHECK(contains(slab, at(-0.5f, 0.5f)) == Containment::Inside);
    CHECK(contains(slab, at(0.5f, 1.5f)) == Containment::Partly);
    CHECK(contains(slab, at(1.5f, 2.5f)) == Containment::Outside);
    CHECK(contains(slab, at(-1, 1)) == Containment::Partly);
    CHECK(contains(slab, at(1, 2)) == Containment::Partly);
    CHECK(contains(slab, {}) == Containment::Outside);
    CHECK(contains(slab, {Vec3(-1e30f), Vec3(1e30f)}) == Containment::Partly);
    CHECK(contains(slab, {Vec3(-INFINITY), Vec3(INFINITY)}) == Containment::Partly);
}

TEST_CASE(
    "culling: a turned box by its closed form; the identity keeps it"
    * technique("engine.hier-bounds")) {
    const Bounds cube = {Vec3(-0.5f), Vec3(0.5f)};
    const Affine turn =
        affine_from({0, 0, 0}, glm::angleAxis(radians(45.0f), Vec3(0, 0, 1)), Vec3(1));
    const Vec3 half = half_extent(transform_bounds(turn, cube));
    CHECK(half.x == test::near(0.707107f).epsilon(1e-6));
    CHECK(half.y == test::near(0.707107f).epsilon(1e-6));
    CHECK(half.z == test::near(0.5f).epsilon(1e-6));
    const Bounds box = {{-2, 3, -7}, {1, 4, 9}};
    const Bounds same = transform_bounds(affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(1)), box);
    CHECK(same.min == box.min);
    CHECK(same.max == box.max);
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
