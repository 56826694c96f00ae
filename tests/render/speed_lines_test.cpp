#include "ecs/components/speed_lines.h"
#include "ecs/components/time.h"
#include "render/graph/frame_graph.h"
#include "render/lens/speed_line_pass.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <limits>

namespace limn::test::speed_lines_test {
namespace {

constexpr SpeedLines kLines = {.count = 500, .length_scale = 0.1f, .min_speed = 2};

/// Of a unit ball that goes by `step` in `seconds`.
std::vector<SpeedLine>
lines_of(const Vec3& step, float seconds, const SpeedLines& settings = kLines) {
    static const MeshData kBall = make_ball(24);
    std::vector<SpeedLine> lines;
    append_speed_lines(kBall, at({1, 2, 3}), at(Vec3(1, 2, 3) - step), seconds, settings, lines);
    return lines;
}

}  // namespace

TEST_CASE(
    "speed lines: there are none below the minimum speed, and none without motion"
    * technique("post.speed-lines")) {
    CHECK(lines_of({0.19f, 0, 0}, 0.1f).empty());
    CHECK_FALSE(lines_of({0.21f, 0, 0}, 0.1f).empty());
    CHECK(lines_of({0, 0, 0}, 0.1f).empty());
    SpeedLines any = kLines;
    any.min_speed = 0;
    CHECK(lines_of({0, 0, 0}, 0.1f, any).empty());
    CHECK(lines_of({0.5f, 0, 0}, 0, any).empty());
    CHECK(lines_of({std::numeric_limits<float>::quiet_NaN(), 0, 0}, 0.1f, any).empty());
}

TEST_CASE(
    "speed lines: each points straight back along the motion, by the distance moved in their time"
    * technique("post.speed-lines")) {
    const Vec3 velocity = Vec3(0.5f, -0.2f, 0.3f) / 0.1f;
    const std::vector<SpeedLine> lines = lines_of(0.1f * velocity, 0.1f);
    REQUIRE(lines.size() > 100);
    for (const SpeedLine& line : lines) {
        CHECK(glm::distance(line.tail - line.head, -0.1f * velocity) < 1e-4f);
    }
}

TEST_CASE(
    "speed lines: they begin only where the surface faces away from its motion"
    * technique("post.speed-lines")) {
    const Vec3 step = {0.5f, 0, 0};
    for (const SpeedLine& line : lines_of(step, 0.1f)) {
        CHECK(glm::dot(line.head - Vec3(1, 2, 3), step) < 1e-5f);  // of a ball: the normal
    }
    // A mirror image trails on the side where it trails, too.
    std::vector<SpeedLine> mirrored;
    const auto pose = [](float x) { return affine_from({x, 0, 0}, {1, 0, 0, 0}, {-1, 1, 1}); };
    append_speed_lines(make_ball(24), pose(0), pose(-0.5f), 0.1f, kLines, mirrored);
    REQUIRE(mirrored.size() > 100);
    for (const SpeedLine& line : mirrored) {
        CHECK(line.head.x < 1e-5f);
    }
}

TEST_CASE("speed lines: there are no more than requested, nor than the mesh has points") {
    SpeedLines few = kLines;
    few.count = 10;
    CHECK(lines_of({0.5f, 0, 0}, 0.1f, few).size() <= 10);
    few.count = -3;
    CHECK(lines_of({0.5f, 0, 0}, 0.1f, few).empty());
    few.count = 1 << 30;
    CHECK(lines_of({0.5f, 0, 0}, 0.1f, few).size() <= make_ball(24).positions.size());
}

TEST_CASE_FIXTURE(
    Scene, "speed lines: they trail in the image, occluded by nearer surfaces"
               * technique("post.speed-lines")) {
    world.insert_resource(FrameTime{.step = 0.1f});
    const MaterialId black =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}});
    const MeshId ball = add(make_ball(24));
    const auto pose = [](float x) { return affine_from({x, 0, -2}, {1, 0, 0, 0}, Vec3(0.4f)); };
    const Entity flying = place(ball, black, pose(0.8f));
    world.get<PreviousWorldTransform>(flying).world = pose(0.2f);
    const RenderView view = look({0, 0, 1}, {0, 0, -2});
    const auto light_at = [&](int begin, int end) {
        const gpu::FloatImage image = radiance(view);
        float sum = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = begin; x < end; ++x) {
                sum += image.at(x, y, 0);
            }
        }
        return sum;
    };
    CHECK(light_at(0, 64) == 0.0f);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("speed lines"));
    world.add(flying, SpeedLines{.count = 400, .length_scale = 0.2f, .min_speed = 2});
    const int center = 32 + static_cast<int>(0.8f / 3 * 32);
    CHECK(light_at(0, center) > 10);
    CHECK(light_at(center + 6, 64) == 0.0f);  // nothing ahead
    const float free = light_at(0, 64);
    place(add(make_square()), black, at({0, 0, 0}));
    CHECK(light_at(0, 64) < 0.01f * free);
}

}  // namespace limn::test::speed_lines_test
