#pragma once

#include "content/app/commands/command_values.h"
#include "content/load/scene_load.h"
#include "ecs/base/result.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "systems/update_world.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace limn {

// A loaded scene with its world and schedule, the starting point of every command that shows or
// measures one.

struct Stage {
    World world;
    Schedule schedule;
    LoadedScene scene;
};

/// Systems of levels beside those of the engine: the game's, and what content grows as it is
/// edited.
void add_stage_systems(SystemList& systems);

struct StageOptions {
    std::optional<std::uint64_t> seed = {};        ///< overrides the level's
    std::span<const Assignment> assignments = {};  ///< applied after loading, in order
    ShowChoice show = {};
    MadeAssets* made = nullptr;  ///< what levels loaded before have generated
    ModelViewOptions model = {};
};

/// Fails with the loader's error, or that of the first invalid assignment.
[[nodiscard]] Result<std::unique_ptr<Stage>>
open_stage(const std::string& scene, const StageOptions& options = {});

/// One step of the simulation.
void step_stage(Stage& stage);

/// Steps until the simulation has reached `time` [s], at most one step beyond. Returns the
/// interpolation factor of `time` between the last two states: 0 the previous, 1 the current.
float advance_stage(Stage& stage, double time);

/// Simulation time after the last step, and the length of a step [s].
[[nodiscard]] double stage_time(const Stage& stage);
[[nodiscard]] double stage_step(const Stage& stage);

}  // namespace limn
