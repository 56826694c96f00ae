#include "content/app/commands/stage.h"

#include "content/bake/furrow_skin.h"
#include "content/game/game.h"
#include "content/load/level/set_value.h"
#include "ecs/base/log.h"
#include "ecs/components/time.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace limn {
namespace {

// Fraction of a step. A step is a float, so n steps and n / 60 s drift apart, by less than this for
// nine minutes.
constexpr double kRounding = 1e-3;

}  // namespace

void add_stage_systems(SystemList& systems) {
    add_game_systems(systems);
    systems.add<update_furrow_skins>(Phase::Create, When::Both);
}

Result<std::unique_ptr<Stage>> open_stage(const std::string& scene, const StageOptions& options) {
    register_game_components();
    auto stage = std::make_unique<Stage>();
    Result<LoadedScene> loaded = load_scene(
        stage->world, scene,
        {.seed = options.seed, .show = options.show, .made = options.made, .model = options.model});
    if (!loaded) {
        return loaded.error();
    }
    stage->scene = *std::move(loaded);
    stage->schedule = make_world_schedule(add_stage_systems);
    start_world(stage->world, add_stage_systems);
    for (const Assignment& assignment : options.assignments) {
        const Status status = set_value(stage->world, assignment.path, assignment.value);
        if (!status) {
            return status.error();
        }
    }
    stage->world.run(update_furrow_skins);  // after assignments: a frame may need no step
    return stage;
}

std::vector<SceneSound> stage_sounds(const Stage& stage) {
    std::vector<std::string> problems;
    const std::string folder = std::filesystem::path(stage.scene.path).parent_path().string();
    std::vector<SceneSound> sounds = find_sounds(stage.world, folder, problems);
    for (const std::string& problem : problems) {
        log_warn("{}", problem);
    }
    return sounds;
}

void step_stage(Stage& stage) {
    step_world(stage.world, stage.schedule);
}

double stage_time(const Stage& stage) {
    return stage.world.resource<FrameTime>().time;
}

double stage_step(const Stage& stage) {
    return static_cast<double>(stage.world.resource<FrameTime>().step);
}

float advance_stage(Stage& stage, double time) {
    const double step = stage_step(stage);
    while (stage_time(stage) < time - kRounding * step) {
        step_stage(stage);
    }
    const double behind = (stage_time(stage) - time) / step;
    return behind < kRounding ? 1.0f : static_cast<float>(std::max(1.0 - behind, 0.0));
}

}  // namespace limn
