#include "content/app/commands/hash_command.h"

#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "ecs/base/jobs.h"
#include "ecs/snapshot.h"

#include <fmt/format.h>

namespace limn {

Status run_hash(const HashOptions& options) {
    if (options.threads > 0) {
        set_thread_count(options.threads);
    }
    Result<std::unique_ptr<Stage>> stage = open_stage(options.scene, {.seed = options.seed});
    if (!stage) {
        return stage.error();
    }
    Progress progress("step", options.frames);
    for (int frame = 0; frame < options.frames; ++frame) {
        step_stage(**stage);
        fmt::print("{} {:016x}\n", frame, state_hash((*stage)->world));
        progress.update(frame + 1);
    }
    return Done{};
}

}  // namespace limn
