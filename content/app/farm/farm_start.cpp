#include "content/app/commands/image_file.h"
#include "content/app/commands/render_frames.h"
#include "content/app/commands/stage.h"
#include "content/app/farm/child_process.h"
#include "content/app/farm/farm_check.h"
#include "content/app/farm/farm_command.h"
#include "content/app/farm/farm_json.h"
#include "content/app/farm/farm_run.h"
#include "content/app/farm/farm_status.h"
#include "content/app/farm/farm_tasks.h"
#include "content/load/files/atomic_file.h"
#include "content/load/level/level_show.h"
#include "content/sound/scene_sound.h"
#include "ecs/base/hash.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kDefaultSlots = 2;
constexpr int kMaxAutoChunk = 32;      // frames
constexpr int kChunksPerProcess = 4;   // for an even end
constexpr int kSlurmProcesses = 8;     // as if, where nobody says how many
constexpr double kCancelSeconds = 30;  // until all processes must have ended

volatile std::sig_atomic_t interrupted = 0;

std::string absolute(const std::string& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
}

/// The folder of a new job: --job, that of --out, or named after the film or the scene.
std::string choose_folder(const FarmOptions& options, const std::string& scene) {
    if (!options.folder.empty()) {
        return absolute(options.folder);
    }
    if (film_kind(options.render.out)) {
        return absolute(options.render.out + ".farm");
    }
    const std::filesystem::path folder =
        std::filesystem::path(options.render.out).lexically_normal().parent_path();
    return absolute(folder.empty() ? scene + ".farm" : folder.string());
}

int choose_chunk(const FarmOptions& options, std::size_t frames) {
    if (options.chunk > 0) {
        return options.chunk;
    }
    const std::size_t nodes = std::max<std::size_t>(options.hosts.size(), 1);
    const std::size_t processes =
        options.scheduler == FarmScheduler::Slurm && options.slots == 0
            ? kSlurmProcesses
            : nodes * static_cast<std::size_t>(options.slots > 0 ? options.slots : kDefaultSlots);
    return static_cast<int>(
        std::clamp<std::size_t>(frames / (processes * kChunksPerProcess), 1, kMaxAutoChunk));
}

constexpr double kMoreSound = 120;  ///< [s] kept beyond the film, for frames that are added

/// When all sounds have been heard.
double end_of_sounds(const std::vector<SceneSound>& sounds) {
    double end = 0;
    for (const SceneSound& sound : sounds) {
        end = std::max(end, sound.every > 0 ? INFINITY : sound.start + sound.data.duration());
    }
    return end;
}

/// Keeps what is heard of the scene for the film, also of frames that `resume` may add.
Status freeze_sound(const Stage& stage, FarmJob& job) {
    const std::vector<SceneSound> sounds = stage_sounds(stage);
    const bool is_silent =
        job.film.empty() || film_kind(job.film) == FilmKind::Gif || sounds.empty();
    if (is_silent || !job.film_settings.sound.empty()) {
        return Done{};
    }
    const double film_end = (job.frames.back() + 1) / job.fps;
    const double end = std::max(
        {film_end, stage.scene.duration, std::min(end_of_sounds(sounds), film_end + kMoreSound)});
    const std::string file = job.folder + "/scene.wav";
    LIMN_TRY(save_wave(mix_sounds(sounds, 0, end), file));
    job.film_settings.sound = LIMN_TRY(freeze_other_file(job, "sound", file));
    job.scene_sound = true;
    job.whole_sound = end_of_sounds(sounds) <= end;
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    return Done{};
}

/// Loads the scene once, to see that it can be, and keeps copies of all that it read.
Status freeze_scene(const FarmOptions& options, FarmJob& job) {
    const std::string scene = !options.render.scene.empty()
                                  ? options.render.scene
                                  : LIMN_TRY(find_show(options.render.show.technique)).level.path;
    std::string path;
    std::vector<std::string> read;
    {
        const ReadRecorder recorder;
        const std::unique_ptr<Stage> stage = LIMN_TRY(open_stage(
            scene, {.seed = options.render.seed,
                    .assignments = options.render.assignments,
                    .show = options.render.show,
                    .model = options.render.model}));
        LIMN_TRY(choose_camera(*stage, options.render.camera));
        path = absolute(stage->scene.path);
        read = recorder.paths();
        LIMN_TRY(freeze_sound(*stage, job));
    }
    const std::string root = std::filesystem::path(path).parent_path().string();
    std::vector<std::string> files;
    for (const std::string& file : read) {
        const std::string whole = absolute(file);
        if (whole.starts_with(root + "/")) {  // others are caches: each node makes its own
            files.push_back(whole);
        }
    }
    job.scene = std::filesystem::path(path).filename().string();
    return freeze_inputs(job, root, files);
}

/// Files that options name: the job gets copies, and their paths below inputs/.
Status freeze_other_inputs(FarmJob& job) {
    const std::string backdrop = "--backdrop=";
    for (std::string& word : job.render) {
        std::error_code ignored;
        if (word.starts_with(backdrop)
            && std::filesystem::is_regular_file(word.substr(backdrop.size()), ignored)) {
            word = backdrop
                   + LIMN_TRY(freeze_other_file(job, "backdrop", word.substr(backdrop.size())));
        }
    }
    if (!job.film_settings.sound.empty() && !job.scene_sound) {
        job.film_settings.sound =
            LIMN_TRY(freeze_other_file(job, "sound", job.film_settings.sound));
    }
    return Done{};
}

/// Different for each job.
std::string make_id(const FarmJob& job) {
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    return fmt::format(
        "{:016x}",
        hash_combine(
            hash_combine(hash_text(job.command), hash_text(job.folder)),
            hash_combine(static_cast<std::uint64_t>(now), static_cast<std::uint64_t>(::getpid()))));
}

/// The folder's name goes into JSON.
bool is_utf8(const std::string& text) {
    try {
        static_cast<void>(FarmJson(text).dump());
        return true;
    } catch (const FarmJson::exception&) {
        return false;
    }
}

Status check_new_folder(const std::string& folder) {
    if (!is_utf8(folder)) {
        return fail("{}: found bytes that are not UTF-8, expected a name of text", folder);
    }
    std::error_code ignored;
    if (std::filesystem::exists(folder + "/job.json", ignored)) {
        return fail(
            "{}: found a job, expected a new folder; limn farm resume goes on with it", folder);
    }
    return Done{};
}

Result<FarmJob> make_job(const FarmOptions& options) {
    FarmJob job;
    job.program = program_path();
    job.version = LIMN_VERSION;
    job.command = options.command;
    job.scheduler = options.scheduler;
    job.hosts = options.hosts;
    job.partition = options.partition;
    job.slots = options.slots > 0 || options.scheduler == FarmScheduler::Slurm ? options.slots
                                                                               : kDefaultSlots;
    job.order = options.order;
    job.retries = options.retries;
    job.timeout = options.timeout;
    job.memory_mib = options.memory_mib;
    job.verify = options.verify;
    LIMN_TRY(check_scheduler(job));
    job.program_hash = LIMN_TRY(hash_program());
    if (!options.tasks.empty()) {
        LIMN_TRY(add_tasks(job, options.tasks));
        job.folder =
            absolute(options.folder.empty() ? options.tasks.front() + ".farm" : options.folder);
        LIMN_TRY(check_new_folder(job.folder));
        job.id = make_id(job);
        LIMN_TRY(save_farm_job(job));
        return job;
    }
    const std::string stem =
        std::filesystem::path(
            options.render.scene.empty() ? options.render.show.technique : options.render.scene)
            .stem()
            .stem()
            .string();
    job.folder = choose_folder(options, stem);
    LIMN_TRY(check_new_folder(job.folder));
    job.id = make_id(job);
    job.render = options.words;
    job.size = options.render.size;
    job.fps = options.render.fps;
    job.frames = options.frames;
    job.chunk = choose_chunk(options, job.frames.size());
    if (film_kind(options.render.out)) {
        job.film = std::filesystem::path(absolute(options.render.out))
                       .lexically_relative(job.folder)
                       .string();
        job.film_settings = options.render.film;
        job.film_settings.fps = job.fps;
        LIMN_TRY(check_film(absolute(options.render.out), job.film_settings));
        job.name = "frame_%05d.png";
    } else {
        job.name = std::filesystem::path(options.render.out).filename().string();
    }
    std::error_code error;
    std::filesystem::create_directories(job.folder + "/inputs", error);
    if (error) {
        return fail("{}/inputs: {}", job.folder, error.message());
    }
    LIMN_TRY(freeze_scene(options, job));
    LIMN_TRY(freeze_other_inputs(job));
    LIMN_TRY(save_farm_job(job));
    LIMN_TRY(check_space(job));
    return job;
}

/// Starts `limn farm coordinate` as a process that outlives this one. Its id.
Result<pid_t> start_coordinator(const FarmJob& job) {
    const std::string log = job.folder + "/log/coordinator.txt";
    const std::string program = program_path();
    const int file = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (file < 0) {
        return fail("{}: {}", log, std::strerror(errno));
    }
    const pid_t process = ::fork();
    if (process == 0) {
        ::setsid();
        ::dup2(::open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        ::execl(
            program.c_str(), "limn", "farm", "coordinate", job.folder.c_str(),
            static_cast<char*>(nullptr));
        ::_exit(127);
    }
    ::close(file);
    if (process < 0) {
        return fail("{}: {}", program, std::strerror(errno));
    }
    return process;
}

/// result.json, as an outcome.
Status read_result(const FarmJob& job) {
    const FarmJson object = read_farm_json(job.folder + "/result.json");
    if (!object.contains("done")) {
        LIMN_TRY(check_space(job));
        return fail("{}: found no result; {}/log/coordinator.txt says why", job.folder, job.folder);
    }
    const std::string failure = member_or(object, "failure", std::string());
    return failure.empty() ? Status(Done{}) : Status(Error{failure});
}

/// Prints how far the job is until nothing goes on with it, or Ctrl-C.
Status watch(const FarmJob& job, pid_t coordinator, bool cancel_on_interrupt) {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };
    ::sigaction(SIGINT, &action, nullptr);
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    double cost = 0;  // of reading the status [s]
    for (;;) {
        const auto pause = std::chrono::duration<double>(std::max(0.3, 5 * cost));
        for (auto begin = Clock::now(); Clock::now() - begin < pause && interrupted == 0;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        if (interrupted != 0 && cancel_on_interrupt) {
            FarmJobOptions options;
            options.folder = job.folder;
            return run_farm_cancel(options);
        }
        if (interrupted != 0) {
            fmt::print("\n{}: goes on; limn farm status|cancel {}\n", job.folder, job.folder);
            return Done{};
        }
        const auto begin = Clock::now();
        int ended = 0;
        const bool over =
            coordinator > 0 ? ::waitpid(coordinator, &ended, WNOHANG) != 0 : !is_coordinated(job);
        if (over && coordinator > 0 && WIFEXITED(ended) && WEXITSTATUS(ended) == kJobIsTaken) {
            return job_is_taken(job);
        }
        const FarmStatus status = read_farm_status(job);
        cost = std::chrono::duration<double>(Clock::now() - begin).count();
        if (terminal) {
            fmt::print(stderr, "\r\033[K{}", summarize_status(job, status));
            std::fflush(stderr);
        }
        if (over) {
            fmt::print(stderr, "{}", terminal ? "\r\033[K" : "");
            fmt::print("{}", describe_status(job, read_farm_status(job)));
            std::fflush(stdout);
            return read_result(job);
        }
    }
}

/// Waits until the coordinator has the job: from then on, `limn farm cancel` reaches it.
Status await_claim(const FarmJob& job, pid_t coordinator) {
    int ended = 0;
    while (coordinator > 0 && ::waitpid(coordinator, &ended, WNOHANG) == 0) {
        const std::optional<FarmWorker> claimed = find_coordinator(job);
        if (claimed && claimed->pid == coordinator) {
            return Done{};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    const bool taken = WIFEXITED(ended) && WEXITSTATUS(ended) == kJobIsTaken;
    return taken ? Status(job_is_taken(job)) : Status(Done{});
}

/// Starts workers for what is missing, and watches.
Status start(const FarmJob& job, bool detach, bool cancel_on_interrupt) {
    pid_t coordinator = 0;
    if (job.scheduler == FarmScheduler::Slurm) {
        const FarmWorker self = make_worker({});
        if (!claim_job(job, self)) {
            return job_is_taken(job);
        }
        const Heartbeat heartbeat(job, self);
        forget_rounds(job);
        const Status queued = next_round(job);
        release_job(job, self);
        LIMN_TRY(queued);
    } else {
        coordinator = LIMN_TRY(start_coordinator(job));
    }
    if (detach) {
        LIMN_TRY(await_claim(job, coordinator));
        fmt::print("{}: started; limn farm status|cancel {}\n", job.folder, job.folder);
        return Done{};
    }
    return watch(job, coordinator, cancel_on_interrupt);
}

}  // namespace

Status run_farm(const FarmOptions& options) {
    const FarmJob job = LIMN_TRY(make_job(options));
    fmt::print(
        "{}: {} {} in chunks of {}, {} input files\n", job.folder, job.frames.size(),
        job.tasks.empty() ? "frames" : "tasks", job.chunk, job.inputs.size());
    std::fflush(stdout);
    return start(job, options.detach, options.cancel_on_interrupt);
}

Status run_farm_status(const FarmJobOptions& options) {
    const FarmJob job = LIMN_TRY(load_farm_job(options.folder));
    const FarmStatus status = read_farm_status(job);
    fmt::print("{}", options.json ? status_json(job, status) : describe_status(job, status));
    return Done{};
}

/// The film may end after the kept sound, where the scene is still heard.
Status warn_of_silence(const FarmJob& job) {
    if (job.scene_sound && !job.whole_sound) {
        const std::string file = job.folder + "/inputs/" + job.film_settings.sound;
        const double end = LIMN_TRY(load_sound(file)).duration();
        if ((job.frames.back() + 1) / job.fps > end) {
            log_warn(
                "{}: the kept sound ends at {} s; a new job has what is heard after that", file,
                fmt::format("{:.1f}", end));
        }
    }
    return Done{};
}

Status run_farm_resume(const FarmJobOptions& options) {
    FarmJob job = LIMN_TRY(load_farm_job(absolute(options.folder)));
    LIMN_TRY(check_scheduler(job));
    if (is_coordinated(job)) {
        return job_is_taken(job);
    }
    if (const std::string difference = find_difference(job); !difference.empty()) {
        return fail("{}: {}", job.folder, difference);
    }
    if (!options.frames.empty() && !job.tasks.empty()) {
        return fail("--frames: found some, expected none: {} is a job of commands", job.folder);
    }
    if (!options.frames.empty()) {
        std::vector<int> all;
        std::ranges::set_union(job.frames, options.frames, std::back_inserter(all));
        job.frames = std::move(all);
        LIMN_TRY(save_farm_job(job));
        LIMN_TRY(warn_of_silence(job));
    }
    std::error_code ignored;
    std::filesystem::remove(job.folder + "/cancel", ignored);
    const std::vector<FrameProblem> problems = check_frames(job);
    for (const FrameProblem& problem : problems) {
        if (!options.json) {
            fmt::print("frame {}: {}\n", problem.frame, problem.what);
        }
        forget_frame(job, problem.frame);
    }
    const bool has_film = job.film.empty() || std::filesystem::exists(film_path(job), ignored);
    if (problems.empty() && has_film && read_result(job)) {
        fmt::print(
            "{}: all {} frames are whole, nothing is to be done\n", job.folder, job.frames.size());
        return Done{};
    }
    std::filesystem::remove_all(job.folder + "/nodes", ignored);
    std::filesystem::create_directory(job.folder + "/nodes", ignored);
    return start(job, options.detach, options.cancel_on_interrupt);
}

Status run_farm_cancel(const FarmJobOptions& options) {
    const FarmJob job = LIMN_TRY(load_farm_job(absolute(options.folder)));
    if (!is_coordinated(job) && list_workers(job).empty() && read_result(job)) {
        return fail("{}: found a job that is done, expected one that goes on", job.folder);
    }
    LIMN_TRY(write_file(job.folder + "/cancel", std::string("limn farm resume removes this\n")));
    cancel_slurm(job);
    const auto begin = Clock::now();
    std::set<int> processes;  // of this node, which may outlive their files by a moment
    const auto alive = [&] {
        bool found = is_coordinated(job);
        for (const FarmWorker& worker : list_workers(job)) {
            found = found || !worker.dead;
            if (!worker.dead && worker.node == node_name()) {
                processes.insert(worker.pid);
            }
        }
        while (::waitpid(-1, nullptr, WNOHANG) > 0) {
        }
        return found || std::ranges::any_of(processes, [](int process) {
                   return ::kill(process, 0) == 0;
               });
    };
    while (alive()) {
        if (Clock::now() - begin > std::chrono::duration<double>(kCancelSeconds)) {
            return fail(
                "{}: cancelled, but processes still run after {} s", job.folder, kCancelSeconds);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    static_cast<void>(finish_job(job, {}));  // its outcome is that it was cancelled
    fmt::print("{}: cancelled, {}\n", job.folder, summarize_status(job, read_farm_status(job)));
    return Done{};
}

}  // namespace limn
