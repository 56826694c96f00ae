#include "ecs/components/tangent_frames.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

namespace limn::test::tangent_frames_test {
namespace {

/// The square of side 2, black, viewed a quarter from the side so that normals are seen, too.
struct FrameScene : Scene {
    Entity square = place(
        add(make_square()),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}}), at({0, 0, 0}));
    RenderView view = look({2.5f, 0.6f, 5}, {0, 0, 0}, 256, 256);

    /// Whether a pixel about the projection of a point has this color.
    bool shows(const gpu::FloatImage& image, const Vec3& point, const Vec3& color) const {
        const Vec4 clip = view.clip_from_world * Vec4(point, 1);
        const Vec2 ndc = Vec2(clip) / clip.w;
        const int x = static_cast<int>((0.5f + 0.5f * ndc.x) * 256);
        const int y = static_cast<int>((0.5f - 0.5f * ndc.y) * 256);
        for (int j = y - 1; j <= y + 1; ++j) {
            for (int i = x - 1; i <= x + 1; ++i) {
                if (i >= 0 && j >= 0 && i < 256 && j < 256 && rgb_at(image, i, j) == color) {
                    return true;
                }
            }
        }
        return false;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    FrameScene, "tangent frames: each vertex has three lines: tangent, bitangent and normal"
                    * technique("bump.frame-view")) {
    world.insert_resource(TangentFrames{0.4f});
    const gpu::FloatImage image = radiance(view);
    const Vec3 green = {0, 1, 0};
    const Vec3 blue = {0, 0, 1};
    const Vec3 red = {1, 0, 0};
    // Of the square, u runs along +x and v down; the bitangent points up.
    for (const Vec2 corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(-1, 1), Vec2(1, 1)}) {
        const Vec3 p(corner, 0);
        CHECK(shows(image, p + Vec3(0.25f, 0, 0), green));
        CHECK(shows(image, p + Vec3(0, 0.25f, 0), blue));
        CHECK(shows(image, p + Vec3(0, 0, 0.25f), red));
        // No longer than asked for.
        CHECK_FALSE(shows(image, p + Vec3(0.5f, 0, 0), green));
        CHECK_FALSE(shows(image, p + Vec3(0, 0, 0.6f), red));
    }
}

TEST_CASE_FIXTURE(
    FrameScene, "tangent frames: of length 0 there are none" * technique("bump.frame-view")) {
    const gpu::FloatImage plain = radiance(view);
    world.insert_resource(TangentFrames{0});
    CHECK(largest_difference(radiance(view), plain) == 0);
}

TEST_CASE_FIXTURE(
    FrameScene,
    "tangent frames: a mesh without tangents has normals only" * technique("bump.frame-view")) {
    world.insert_resource(TangentFrames{0.4f});
    world.resource<Assets>().meshes[0].tangents.clear();
    ++world.resource<Assets>().meshes[0].version;
    const gpu::FloatImage image = radiance(view);
    CHECK(shows(image, {1, 1, 0.25f}, {1, 0, 0}));
}

}  // namespace limn::test::tangent_frames_test
