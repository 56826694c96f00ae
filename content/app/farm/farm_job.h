#pragma once

#include "content/app/commands/film_writer.h"
#include "content/app/farm/frame_list.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <string>
#include <vector>

namespace limn {

// A job of `limn farm` is a folder that can be moved, and read without a program:
//
//     job.json     what is rendered, by which program, how: written once
//     inputs/      the level and all files that it read, as they were; job.json has their hashes
//     frames/      the images, under their final names when they are whole
//     state/       a small file a frame, in folders of a thousand (farm_state.h)
//     nodes/       what each node is like, and which frames failed on it
//     workers/     a file for each process that renders, renewed as it lives
//     plan/        the chunks of each round
//     log/         what the processes printed
//
// Every number that a command shows comes from these files; no process has to be asked.

/// Who starts processes on nodes.
enum class FarmScheduler { Local, Parallel, Slurm };

/// A file of inputs/.
struct FarmInput {
    std::string path;         ///< below inputs/
    std::uint64_t hash = 0;   ///< hash_bytes
    std::uint64_t bytes = 0;  ///< its size
};

struct FarmJob {
    std::string folder;              ///< where it is now; not part of job.json
    std::string id;                  ///< hexadecimal digits, part of the name of its jobs in Slurm
    std::string program;             ///< path of `limn`, the same on all nodes
    std::string version;             ///< of the program
    std::uint64_t program_hash = 0;  ///< of its file
    std::string command;             ///< as it was typed
    std::string scene;               ///< of frames: below inputs/
    std::vector<std::string>
        render;  ///< of frames: options of `limn render`, without scene, range and name
    std::vector<std::vector<std::string>> tasks;  ///< instead of frames: commands, by number
    std::string name;               ///< of a frame's file, with %05d; of tasks: "%05d.json"
    IVec2 size = {0, 0};            ///< of a frame [pixels]
    double fps = 60;                ///< frames per second
    std::vector<FarmInput> inputs;  ///< by path
    std::vector<int> frames;        ///< rising, each once
    std::string film;  ///< made of the frames at the end, relative to the job; empty: none
    FilmSettings film_settings;  ///< of that
    bool scene_sound = false;    ///< its sound is the scene's own, from 0 s on
    bool whole_sound = false;    ///< the kept sound reaches the end of the scene's sounds
    FarmScheduler scheduler = FarmScheduler::Local;
    std::vector<std::string> hosts;  ///< of Parallel: for ssh, ":" is this machine
    std::string partition;           ///< of Slurm; empty: its default
    int slots = 0;                   ///< processes a node; Slurm: in all, 0: as many as it starts
    int chunk = 1;                   ///< frames that one process renders
    FrameOrder order = FrameOrder::Plain;
    int retries = 3;       ///< tries of a frame before it counts as failed
    double timeout = 600;  ///< without progress [s] before a process is ended
    int memory_mib = 0;    ///< of a process; 0: no limit
    double verify = 0;     ///< share of frames that are rendered a second time, 0 .. 1
};

/// Reads job.json. Fails with file, what was found and what was expected.
[[nodiscard]] Result<FarmJob> load_farm_job(const std::string& folder);

/// Makes the folders and writes job.json.
[[nodiscard]] Status save_farm_job(const FarmJob& job);

/// Writes as much as a frame takes, and removes it. Fails where the folder is not writable, or
/// full.
[[nodiscard]] Status check_space(const FarmJob& job);

/// Where an image is when it is whole.
[[nodiscard]] std::string frame_path(const FarmJob& job, int frame);

/// Hash of the file of the running program, and its path.
[[nodiscard]] Result<std::uint64_t> hash_program();
[[nodiscard]] std::string program_path();

/// How this machine is called: LIMN_FARM_NODE, or as Slurm or GNU Parallel call it, or its own
/// name; letters, digits, '.', '-' and '_' only.
[[nodiscard]] std::string node_name();

/// Why this program and the files of inputs/ are not those of the job; empty: they are.
[[nodiscard]] std::string find_difference(const FarmJob& job);

/// Copies `files`, all below `root`, to inputs/ and lists them in the job.
[[nodiscard]] Status
freeze_inputs(FarmJob& job, const std::string& root, const std::vector<std::string>& files);

/// Copies one file from anywhere to `folder` of inputs/. Its path below inputs/.
[[nodiscard]] Result<std::string>
freeze_other_file(FarmJob& job, const std::string& folder, const std::string& file);

}  // namespace limn
