#include "ecs/components/rendering.h"
#include "render/material/detail_limit.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

namespace limn::test::detail_limit_test {
namespace {

constexpr SurfaceDetail kDetails[] = {
    SurfaceDetail::Normal,       SurfaceDetail::Flat,     SurfaceDetail::Bump,
    SurfaceDetail::ObjectNormal, SurfaceDetail::Parallax, SurfaceDetail::Occlusion,
    SurfaceDetail::Relief,       SurfaceDetail::Cone,     SurfaceDetail::DoubleDepth,
    SurfaceDetail::Silhouette,   SurfaceDetail::Odd,      SurfaceDetail::Displaced};

constexpr DetailLimit kLimits[] = {DetailLimit::Full,      DetailLimit::Relief,
                                   DetailLimit::Occlusion, DetailLimit::Parallax,
                                   DetailLimit::Normal,    DetailLimit::Flat};

}  // namespace

TEST_CASE(
    "detail limit: dearer details fall to the limit, others stay" * technique("relief.selection")) {
    for (const SurfaceDetail detail : kDetails) {
        CAPTURE(static_cast<int>(detail));
        CHECK(limited_detail(detail, DetailLimit::Full) == detail);
        CHECK(limited_detail(detail, DetailLimit::Flat) == SurfaceDetail::Flat);
        // A second limit that is not lower changes nothing, and one after another is the lower one.
        SurfaceDetail stepped = detail;
        for (const DetailLimit limit : kLimits) {
            const SurfaceDetail once = limited_detail(detail, limit);
            CHECK(limited_detail(once, limit) == once);
            stepped = limited_detail(stepped, limit);
            CHECK(stepped == once);
        }
    }
    CHECK(limited_detail(SurfaceDetail::Silhouette, DetailLimit::Relief) == SurfaceDetail::Relief);
    CHECK(limited_detail(SurfaceDetail::Cone, DetailLimit::Relief) == SurfaceDetail::Cone);
    CHECK(limited_detail(SurfaceDetail::Cone, DetailLimit::Parallax) == SurfaceDetail::Parallax);
    CHECK(limited_detail(SurfaceDetail::Bump, DetailLimit::Normal) == SurfaceDetail::Bump);
}

TEST_CASE_FIXTURE(
    Scene, "detail limit: the image is that of a material with the lower detail"
               * technique("relief.selection")) {
    const ImageId map = add(ImageData{
        .name = "steps",
        .width = 2,
        .height = 2,
        .pixels = {128, 128, 255, 0, 90, 128, 255, 200, 128, 90, 255, 255, 128, 160, 255, 40}});
    Material stone = {.base_color = {1, 1, 1, 1}};
    stone.relief_texture = {.image = map};
    stone.relief_depth = 0.2f;
    stone.base_color_texture = {.image = map};
    const RenderView view = look({0.6f, -0.4f, 0.9f}, {0, 0, 0}, 64, 64);
    const auto image = [&](SurfaceDetail detail, DetailLimit limit) {
        world.clear();
        world.insert_resource(Rendering{.surface_detail = limit});
        world.create(
            DirectionalLight{.illuminance = 3}, WorldTransform{look_at({1, 1, 2}, {0, 0, 0})});
        stone.detail = detail;
        place(add(make_square()), add(stone), at({0, 0, 0}));
        return radiance(view);
    };
    const gpu::FloatImage relief = image(SurfaceDetail::Relief, DetailLimit::Full);
    const gpu::FloatImage parallax = image(SurfaceDetail::Parallax, DetailLimit::Full);
    CHECK(largest_difference(relief, parallax) > 0.05f);
    CHECK(
        largest_difference(image(SurfaceDetail::Relief, DetailLimit::Parallax), parallax) == 0.0f);
    CHECK(
        largest_difference(image(SurfaceDetail::Silhouette, DetailLimit::Relief), relief) == 0.0f);
}

}  // namespace limn::test::detail_limit_test
