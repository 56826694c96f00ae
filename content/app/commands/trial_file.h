#pragma once

#include "content/game/wrinkle_trial.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

/// The answers of a WrinkleTrial's viewers in a file of at most a megabyte.
[[nodiscard]] Result<std::vector<TrialRecord>> load_trials(const std::string& path);

}  // namespace limn
