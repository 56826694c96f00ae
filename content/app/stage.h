#pragma once

#include "content/app/command_values.h"
#include "content/load/scene_load.h"
#include "ecs/base/result.h"
#include "ecs/schedule.h"
#include "ecs/world.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace limn {

// A loaded scene with what moves it: where every command that shows or measures a scene begins.

struct Stage {
    World world;
    Schedule schedule;
    LoadedScene scene;
};

/// Fails with the loader's line, or that of the first assignment that cannot be made.
[[nodiscard]] Result<std::unique_ptr<Stage>> open_stage(
    const std::string& scene, std::optional<std::uint64_t> seed = std::nullopt,
    std::span<const Assignment> assignments = {});

/// One step of the simulation.
void step_stage(Stage& stage);

/// Steps until the simulation has reached `time` [s], at most one step beyond. Returns where `time`
/// lies between the last two steps: 0 at the one before, 1 at the last.
float advance_stage(Stage& stage, double time);

/// The state of the world after its last step, to render: time and length of a step [s].
[[nodiscard]] double stage_time(const Stage& stage);
[[nodiscard]] double stage_step(const Stage& stage);

}  // namespace limn
