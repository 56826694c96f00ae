// What a level needs is compiled when it is loaded: no frame of any level compiles a program, none
// needs more programs than agreed, and a warm-up leaves no trace in the image.

#include "content/app/headless.h"
#include "content/app/stage.h"
#include "content/load/level_list.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shading_comparison.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <map>
#include <string>
#include <vector>

namespace limn::level_warm_up_test {
namespace {

constexpr IVec2 kSize = {64, 36};
constexpr int kPathViews = 8;
constexpr int kSeconds = 10;  // to play, the longest that an event of a level takes to begin

/// Shader programs that a level may need. If a level needs more: find out which definitions it has
/// got (LIMN_SHADER_DUMP writes all programs to a folder). If an effect now makes two programs
/// where one would do, or has definitions that follow the view (render/effect.h), change the
/// effect; if the level shows something new, raise its number to what it needs and a few.
const std::map<std::string, int> kMaxPrograms = {
    {"cistern", 79},   {"cloister", 64}, {"crowd-of-faces", 48},
    {"forge", 57},     {"furrows", 48},  {"gallery", 43},
    {"herd", 43},      {"lagoon", 81},   {"lights", 43},
    {"markers", 48},   {"million", 56},  {"museum", 105},
    {"ocean", 58},     {"phonglab", 60}, {"pond", 62},
    {"portrait", 53},  {"raceway", 78},  {"relax", 50},
    {"stilllife", 73}, {"storm", 75},    {"stress-instances", 41},
    {"vale", 103}};

HeadlessRenderer& shared_headless() {
    static HeadlessRenderer shared = [] {
        Result<HeadlessRenderer> made = create_headless_renderer();
        REQUIRE_MESSAGE(made.ok(), (made ? std::string() : made.error().message));
        return *std::move(made);
    }();
    return shared;
}

std::unique_ptr<Stage> open(const std::string& level) {
    Result<std::unique_ptr<Stage>> stage = open_stage(level);
    REQUIRE_MESSAGE(stage.ok(), (stage ? std::string() : stage.error().message));
    return *std::move(stage);
}

RenderView view_from(const Stage& stage, const Affine& pose) {
    RenderView view = make_render_view(
        stage.world.get<Camera>(stage.scene.camera), pose, pose,
        {.width = kSize.x, .height = kSize.y});
    view.lens = lens_view(stage.world, stage.scene.camera);
    return view;
}

/// Along the whole camera path, and from the middle of the level and below it to all sides.
std::vector<RenderView> many_views(const Stage& stage) {
    std::vector<RenderView> views;
    if (const auto* path = stage.world.find<CameraPath>(stage.scene.camera)) {
        for (int i = 0; i < kPathViews; ++i) {
            const CameraPose pose = camera_pose(*path, stage.scene.duration * i / kPathViews);
            views.push_back(view_from(stage, affine_from(pose.position, pose.rotation, Vec3(1))));
        }
    }
    const Vec3 middle = is_empty(stage.scene.bounds) ? Vec3(0) : center(stage.scene.bounds);
    const Vec3 toward[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const Vec3& direction : toward) {
        for (const float height : {-0.5f, 2.0f, 40.0f}) {
            const Vec3 eye = {middle.x, height, middle.z};
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

TEST_CASE("warm-up: after it no frame of a level compiles a program") {
    HeadlessRenderer& headless = shared_headless();
    for (const LevelEntry& level : list_levels()) {
        CAPTURE(level.name);
        const std::unique_ptr<Stage> stage = open(level.path);
        const int programs = warm_up_world(headless, stage->world, stage->scene.camera, kSize);
        const auto limit = kMaxPrograms.find(level.name);
        CAPTURE(programs);
        CHECK_MESSAGE(limit != kMaxPrograms.end(), "no number of programs agreed, add one");
        CHECK(programs <= (limit != kMaxPrograms.end() ? limit->second : 0));
        int compiled = 0;
        for (const RenderView& view : many_views(*stage)) {
            compiled += render_frame(*headless.renderer, stage->world, view).statistics.compiled;
        }
        // A second of a million particles takes half a minute here, and no event begins later.
        const int seconds = level.name == "million" ? 1 : kSeconds;
        for (int second = 1; second <= seconds; ++second) {
            advance_stage(*stage, second);
            const RenderView view = make_render_view(
                stage->world, stage->scene.camera, {.width = kSize.x, .height = kSize.y});
            compiled += render_frame(*headless.renderer, stage->world, view).statistics.compiled;
        }
        CHECK(compiled == 0);
        // Nor one that another level happened to compile before.
        CHECK(headless.device->shaders().loaded_count() == static_cast<std::size_t>(programs));
    }
}

TEST_CASE(
    "warm-up: where methods of shading are compared, a key that switches one compiles nothing") {
    HeadlessRenderer& headless = shared_headless();
    const std::unique_ptr<Stage> stage = open("phonglab");
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
        const std::unique_ptr<Stage> stage = open(level);
        step_stage(*stage);
        RendererPtr plain = *create_renderer(*shared_headless().device);
        RendererPtr warm = *create_renderer(*shared_headless().device);
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
