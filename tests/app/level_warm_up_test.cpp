// What a level needs is compiled when it is loaded: no frame of any level compiles a program, and a
// warm-up leaves no trace in the image or the state.

#include "content/app/commands/stage.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shading_comparison.h"
#include "ecs/snapshot.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"
#include "tests/app/level_fixture.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::level_warm_up_test {
namespace {

constexpr IVec2 kSize = {64, 36};
constexpr int kPathViews = 8;
constexpr int kSeconds = 10;  // to play, the longest that an event of a level takes to begin

RenderView view_from(const Stage& stage, const Affine& pose) {
    RenderView view = make_render_view(
        stage.world.get<Camera>(stage.scene.camera), pose, pose,
        {.width = kSize.x, .height = kSize.y});
    view.lens = lens_view(stage.world, stage.scene.camera);
    return view;
}

/// Along the whole camera path, and from the center of the level and below it in all directions.
std::vector<RenderView> many_views(const Stage& stage) {
    std::vector<RenderView> views;
    if (const auto* path = stage.world.find<CameraPath>(stage.scene.camera)) {
        for (int i = 0; i < kPathViews; ++i) {
            const CameraPose pose = camera_pose(*path, stage.scene.duration * i / kPathViews);
            views.push_back(view_from(stage, affine_from(pose.position, pose.rotation, Vec3(1))));
        }
    }
    const Vec3 level_center = is_empty(stage.scene.bounds) ? Vec3(0) : center(stage.scene.bounds);
    const Vec3 toward[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const Vec3& direction : toward) {
        for (const float height : {-0.5f, 2.0f, 40.0f}) {
            const Vec3 eye = {level_center.x, height, level_center.z};
            views.push_back(view_from(stage, look_at(eye, eye + direction)));
        }
    }
    return views;
}

gpu::FloatImage radiance_of(Renderer& renderer, const Stage& stage) {
    const RenderView view =
        make_render_view(stage.world, stage.scene.camera, {.width = kSize.x, .height = kSize.y});
    return gpu::read_floats(*render_frame(renderer, stage.world, view).radiance);
}

}  // namespace

TEST_CASE("warm-up: after it no frame of a level compiles a program, and its state is the same") {
    HeadlessRenderer& headless = test::level_renderer();
    for (const test::PlayedLevel& played : test::played_levels()) {
        CAPTURE(played.name);
        const std::unique_ptr<Stage> stage = test::open_level(played.name);
        const int programs = warm_up_world(headless, stage->world, stage->scene.camera, kSize);
        int compiled = 0;
        for (const RenderView& view : many_views(*stage)) {
            compiled += render_frame(*headless.renderer, stage->world, view).statistics.compiled;
        }
        test::step_times(*stage, test::kStepsToRepeat);
        CHECK(state_hash(stage->world) == played.hash);
        // A second of a million particles takes half a minute here, and no event begins later.
        const int seconds = played.name == "million" ? 1 : kSeconds;
        for (int second = 1; second <= seconds; ++second) {
            advance_stage(*stage, second);
            const RenderView view = make_render_view(
                stage->world, stage->scene.camera, {.width = kSize.x, .height = kSize.y});
            compiled += render_frame(*headless.renderer, stage->world, view).statistics.compiled;
        }
        CHECK(compiled == 0);
        // Nor one that another level, or another test, happened to compile before.
        CHECK(headless.device->shaders().loaded_count() == static_cast<std::size_t>(programs));
    }
}

TEST_CASE(
    "warm-up: where methods of shading are compared, a key that switches one compiles nothing") {
    HeadlessRenderer& headless = test::level_renderer();
    const std::unique_ptr<Stage> stage = test::open_level("phonglab");
    (void)warm_up_world(headless, stage->world, stage->scene.camera, kSize);
    const auto compiled = [&] {
        const RenderView view = make_render_view(
            stage->world, stage->scene.camera, {.width = kSize.x, .height = kSize.y});
        return render_frame(*headless.renderer, stage->world, view).statistics.compiled;
    };
    for (int rate = 0; rate < kShadingRates; ++rate) {
        CAPTURE(rate);
        stage->world.resource<Rendering>().shading = static_cast<ShadingRate>(rate);
        CHECK(compiled() == 0);
        stage->world.resource<ShadingComparison>().right = static_cast<ShadingRate>(rate);
        CHECK(compiled() == 0);
    }
}

TEST_CASE("warm-up: frames after it have the bits of those of a renderer without") {
    for (const char* level : {"lagoon", "raceway"}) {
        CAPTURE(level);
        const std::unique_ptr<Stage> stage = test::open_level(level);
        step_stage(*stage);
        RendererPtr plain = *create_renderer(*test::level_renderer().device);
        RendererPtr warm = *create_renderer(*test::level_renderer().device);
        warm_up(
            *warm, stage->world,
            make_render_view(stage->world, stage->scene.camera, {.width = 320, .height = 180}));
        for (int frame = 0; frame < 2; ++frame) {
            CHECK(radiance_of(*plain, *stage).pixels == radiance_of(*warm, *stage).pixels);
            step_stage(*stage);
        }
    }
}

TEST_CASE("warm-up: info prints how many shader programs a level needs") {
    const test::TemporaryFolder folder;
    const test::ProgramRun run = test::run_limn(folder, {"info", "herd"});
    CHECK(run.exit_code == 0);
    CHECK(run.err.empty());
    CHECK(run.out.find(" shader programs\n") != std::string::npos);
}

}  // namespace limn::level_warm_up_test
