#pragma once

#include "content/app/farm/farm_job.h"
#include "content/app/farm/farm_scheduler.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

// A job goes on in rounds. A round is the chunks of all frames that are missing; a frame that
// failed is a chunk of its own, for nodes on which it did not fail. When nothing is missing, a
// share of the frames is rendered a second time elsewhere, and the film is made. GNU Parallel and
// Slurm start the processes of a round.

/// Chunks of the next round; none: nothing is left to do.
[[nodiscard]] std::vector<FarmGroup> plan_round(const FarmJob& job);

/// Frames that are rendered a second time, rising: job.verify of them, evenly spread.
[[nodiscard]] std::vector<int> frames_to_verify(const FarmJob& job);

/// Where the film is to be, and making it of all frames.
[[nodiscard]] std::string film_path(const FarmJob& job);
[[nodiscard]] Status make_job_film(const FarmJob& job);

/// Whether a process or the queue of Slurm goes on with the job.
[[nodiscard]] bool is_coordinated(const FarmJob& job);

/// Exit status of `limn farm coordinate` where another process goes on with the job, and that
/// error.
inline constexpr int kJobIsTaken = 75;
[[nodiscard]] Error job_is_taken(const FarmJob& job);

/// Begins to count rounds anew, and removes the outcome of those before.
void forget_rounds(const FarmJob& job);

/// All rounds, one after another, and the film (Local, Parallel). Fails where frames are missing at
/// the end, and where renderings differ. The job is claimed.
[[nodiscard]] Status run_rounds(const FarmJob& job);

/// Slurm: queues the next round, or ends the job.
[[nodiscard]] Status next_round(const FarmJob& job);

/// What is at the end of a job: the film, if all frames are there; removes what dead processes
/// left. Its outcome is result.json. `why`:
/// what it failed at before; empty: nothing.
[[nodiscard]] Status finish_job(const FarmJob& job, const std::string& why);

}  // namespace limn
