#pragma once

#include "content/app/farm/farm_job.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// Makes the job one of commands instead of frames: `quality --all` is one task an effect, `bench
/// --all` one a level, each with the further words; `quality EFFECT` and `bench LEVEL` are one
/// task. Each writes JSON, frames/00012.json. Fails for other commands.
[[nodiscard]] Status add_tasks(FarmJob& job, const std::vector<std::string>& words);

}  // namespace limn
