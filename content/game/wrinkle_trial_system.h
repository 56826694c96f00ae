#pragma once

#include "content/game/wrinkle_trial.h"
#include "ecs/base/result.h"
#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/time.h"
#include "ecs/components/wrinkle.h"
#include "ecs/query.h"
#include "ecs/resource.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

/// Gives each WrinkleTrial its state.
void add_wrinkle_trials(
    Query<const WrinkleTrial, Without<WrinkleTrialState>> trials, Commands commands);

/// Plays the clips, turns the wrinkles of the face on and off, and takes the viewer's answers; the
/// next viewer's trial follows the last answer. Before update_poses.
void update_wrinkle_trials(
    Query<WrinkleTrial, WrinkleTrialState, ClipPlayer, WrinkleSurface> trials,
    Res<const FrameTime> time);

/// Whether wrinkles come first for this viewer, 0 .. Of every two consecutive viewers, one sees
/// them first and one last.
[[nodiscard]] bool wrinkles_come_first(std::uint64_t seed, std::size_t viewer);

/// Counts of answers: "2/3" is 2 yes and 3 no.
struct TrialTally {
    struct Count {
        std::size_t yes = 0;
        std::size_t no = 0;
    };
    Count noticed_wrinkles_first;
    Count noticed_wrinkles_last;
    Count preferred_wrinkles;
};

[[nodiscard]] TrialTally tally_trials(std::span<const TrialRecord> records);

/// The answers of the ten viewers in the original study: 2/3, 1/4 and 8/2.
[[nodiscard]] TrialTally source_tally();

/// Three lines: the answers beside those of the original study.
[[nodiscard]] std::string describe_tally(const TrialTally& tally);

/// order,noticed,preferred: a line per viewer.
[[nodiscard]] std::string write_trials(std::span<const TrialRecord> records);
/// Fails with "file:line: found X, expected Y".
[[nodiscard]] Result<std::vector<TrialRecord>>
parse_trials(std::string_view text, const std::string& file);

}  // namespace limn
