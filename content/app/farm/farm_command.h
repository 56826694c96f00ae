#pragma once

#include "content/app/commands/command_entry.h"
#include "content/app/commands/render_command.h"
#include "content/app/farm/farm_job.h"
#include "content/app/farm/farm_worker.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

/// `limn farm slurm|parallel|local SCENE ...`: what `limn render` takes, and how it is spread.
struct FarmOptions {
    RenderOptions render;            ///< .out may have a folder, which then is the job's
    std::vector<int> frames;         ///< rising
    std::string folder;              ///< of the job; empty: beside the output
    std::vector<std::string> words;  ///< options of `render`, as given
    std::vector<std::string> tasks;  ///< after "--": `quality --all` or `bench --all ...`
    std::string command;             ///< the whole line
    std::vector<std::string> hosts;  ///< for ssh
    std::string partition;           ///< of Slurm
    FarmScheduler scheduler = FarmScheduler::Local;
    FrameOrder order = FrameOrder::Plain;
    int slots = 0;                     ///< processes a node; 0: 2, with Slurm no limit
    int chunk = 0;                     ///< 0: four chunks a process, at most 32 frames
    int retries = 3;                   ///< tries of a frame
    double timeout = 600;              ///< without progress [s]
    int memory_mib = 0;                ///< of a process; 0: no limit
    double verify = 0;                 ///< share of frames, 0 .. 1
    bool detach = false;               ///< return when it has begun
    bool cancel_on_interrupt = false;  ///< what Ctrl-C does; else the job goes on
};

/// `limn farm status|resume|cancel|check JOB`.
struct FarmJobOptions {
    std::string folder;       ///< of the job
    bool json = false;        ///< print JSON
    std::vector<int> frames;  ///< resume: also these
    bool detach = false;      ///< as FarmOptions
    bool cancel_on_interrupt = false;
};

/// Internal commands: `limn farm work|draw|coordinate|next JOB`.
struct FarmNodeOptions {
    std::string folder;       ///< of the job
    std::string plan;         ///< work: file of chunks
    int line = 0;             ///< work: of that file, from 1
    std::vector<int> frames;  ///< draw
    std::string prefix;       ///< draw: of files
};

/// Options of all of `limn farm`.
struct FarmCommandOptions {
    FarmOptions start;
    FarmJobOptions job;
    FarmNodeOptions node;
};

[[nodiscard]] Command add_farm(CLI::App& program, FarmCommandOptions& options);

/// Freezes the inputs in a new folder, and starts.
[[nodiscard]] Status run_farm(const FarmOptions& options);
[[nodiscard]] Status run_farm_status(const FarmJobOptions& options);
/// Starts again for frames that are missing, damaged, failed or new; no others.
[[nodiscard]] Status run_farm_resume(const FarmJobOptions& options);
/// Ends all processes of the job; returns when they have ended.
[[nodiscard]] Status run_farm_cancel(const FarmJobOptions& options);

}  // namespace limn
