#pragma once

#include "content/app/farm/farm_state.h"
#include "ecs/base/result.h"

#include <string>
#include <vector>

namespace limn {

struct FarmJob;

// GNU Parallel and Slurm start the workers of a round.

/// Chunks that may run on the same nodes.
struct FarmGroup {
    StateFile kind = StateFile::Frame;     ///< of all chunks
    std::vector<std::vector<int>> chunks;  ///< frames of each
    std::vector<std::string> without;      ///< nodes that are to leave them to others
};

/// Writes a group as plan/NAME.txt, a chunk a line, and returns the path.
[[nodiscard]] Result<std::string>
write_plan(const FarmJob& job, const std::string& name, const FarmGroup& group);
/// The chunk of a line, from 1.
struct PlannedChunk {
    StateFile kind = StateFile::Frame;
    std::vector<int> frames;
};
[[nodiscard]] Result<PlannedChunk> read_plan(const std::string& path, int line);

/// Fails with one line where the scheduler's programs are not installed.
[[nodiscard]] Status check_scheduler(const FarmJob& job);

/// Asks the hosts of Parallel whether they see program and job, and notes those that do not.
void check_hosts(const FarmJob& job);

/// Runs all chunks by `parallel`, here or on the job's hosts, and returns when it ends: what its
/// workers did is in their files. Fails where no host is left.
[[nodiscard]] Status
run_parallel(const FarmJob& job, const std::string& name, const FarmGroup& group);

/// Queues all chunks as job arrays, and after them a job that runs `limn farm next`. All have the
/// name limn-ID. On failure some may be queued: cancel_slurm.
[[nodiscard]] Status
submit_slurm(const FarmJob& job, const std::string& name, const std::vector<FarmGroup>& groups);
/// Whether one of them waits or runs.
[[nodiscard]] bool is_queued(const FarmJob& job);
/// Takes them out of the queue, and ends what runs.
void cancel_slurm(const FarmJob& job);

}  // namespace limn
