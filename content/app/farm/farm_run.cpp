#include "content/app/farm/farm_run.h"

#include "content/app/commands/film_command.h"
#include "content/app/farm/child_process.h"
#include "content/app/farm/farm_json.h"
#include "content/app/farm/farm_status.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>
#include <thread>
#include <unistd.h>
#include <utility>

namespace limn {
namespace {

constexpr int kIdleRounds = 2;  // that change nothing: no node can do what is left

/// What rounds change.
struct JobProgress {
    int done = 0;
    int attempts = 0;
    int left_out = 0;
    int verified = 0;
    bool operator==(const JobProgress&) const = default;
};

JobProgress measure(const FarmJob& job) {
    JobProgress progress;
    for (const FrameState& state : read_all_states(job)) {
        progress.done += state.done ? 1 : 0;
        progress.attempts += static_cast<int>(state.attempts.size());
    }
    for (const int frame : frames_to_verify(job)) {
        progress.verified +=
            static_cast<int>(read_frame_state(job, frame, StateFile::Verify).attempts.size());
    }
    for (const FarmNode& node : list_nodes(job)) {
        progress.left_out += node.left_out() ? 1 : 0;
    }
    return progress;
}

/// Whether some worker lives, or may live.
bool has_workers(const FarmJob& job) {
    return std::ranges::any_of(list_workers(job), [](const FarmWorker& worker) {
        return !worker.dead && !worker.chunk.empty();
    });
}

/// A group for each set of nodes to be avoided.
class GroupMaker {
  public:
    void add(StateFile kind, std::vector<std::string> without, std::vector<int> chunk) {
        std::ranges::sort(without);
        FarmGroup& group = groups_[{kind, without}];
        group.kind = kind;
        group.without = without;
        group.chunks.push_back(std::move(chunk));
    }
    std::vector<FarmGroup> take() {
        std::vector<FarmGroup> groups;
        for (auto& [key, group] : groups_) {
            groups.push_back(std::move(group));
        }
        return groups;
    }

  private:
    std::map<std::pair<StateFile, std::vector<std::string>>, FarmGroup> groups_;
};

void plan_verification(const FarmJob& job, GroupMaker& groups) {
    std::map<std::string, std::vector<int>> by_node;
    for (const int frame : frames_to_verify(job)) {
        const FrameState first = read_frame_state(job, frame);
        const FrameState second = read_frame_state(job, frame, StateFile::Verify);
        if (first.done && !second.done && !is_given_up(job, second)) {
            by_node[first.attempts.back().node].push_back(frame);
        }
    }
    for (const auto& [node, frames] : by_node) {
        for (std::vector<int>& chunk : make_chunks(frames, job.chunk, FrameOrder::Plain)) {
            groups.add(StateFile::Verify, {node}, std::move(chunk));
        }
    }
}

/// Removes files under temporary names, and those of dead workers.
void sweep(const FarmJob& job) {
    std::error_code error;
    for (std::filesystem::directory_iterator entry(job.folder + "/frames", error), end;
         !error && entry != end; entry.increment(error)) {
        if (entry->path().filename().string().starts_with('.')) {
            std::error_code ignored;
            std::filesystem::remove(entry->path(), ignored);
        }
    }
    bury_dead_workers(job);
}

/// What a job has failed at; empty: nothing.
std::string failure_of(const FarmJob& job, const FarmStatus& status) {
    if (status.done < status.total) {
        std::string text = fmt::format(
            "{}: {} of {} frames are missing", job.folder, status.total - status.done,
            status.total);
        if (!status.given_up.empty()) {
            const FailedFrame& first = status.given_up.front();
            return text
                   + fmt::format(
                       "; frame {} failed {} times, on {}: {}", first.frame, first.tries,
                       fmt::join(first.nodes, ", "), first.why);
        }
        if (!status.to_retry.empty()) {
            const FailedFrame& first = status.to_retry.front();
            return text + fmt::format("; frame {}: {}", first.frame, first.why);
        }
        for (const NodeStatus& node : status.nodes) {
            text += node.node.refused.empty()
                        ? ""
                        : fmt::format("; {} is left out: {}", node.node.name, node.node.refused);
        }
        return text;
    }
    for (const std::string& difference : status.differences) {
        if (must_not_differ(difference)) {
            return job.folder + ": " + difference;
        }
    }
    if (status.verified < status.to_verify) {
        return fmt::format(
            "{}: found {} of {} second renderings, expected all", job.folder, status.verified,
            status.to_verify);
    }
    return {};
}

/// In a process of its own, so that `limn farm cancel` can end it.
Status make_film_apart(const FarmJob& job) {
    ChildProcess::Options options;
    options.words = {program_path(), "farm", "film", job.folder};
    options.errors = job.folder + "/log/film.txt";
    ::unlink(options.errors.c_str());
    ChildProcess film = LIMN_TRY(ChildProcess::start(options));
    while (!film.is_over()) {
        static_cast<void>(film.read_line(std::chrono::milliseconds(500)));
        if (is_cancelled(job)) {
            return fail("{}: cancelled", job.folder);
        }
    }
    if (film.wait().status != 0) {
        std::ifstream log(options.errors);
        std::string line;
        std::getline(log, line);
        return fail("{}", line.empty() ? film_path(job) + ": could not be made" : line);
    }
    return Done{};
}

/// Idle rounds of Slurm, between processes.
struct RoundRecord {
    int number = 0;
    int idle = 0;
    JobProgress progress;
};

RoundRecord read_record(const FarmJob& job) {
    RoundRecord record;
    std::ifstream file(job.folder + "/plan/round.txt");
    file >> record.number >> record.idle >> record.progress.done >> record.progress.attempts
        >> record.progress.left_out >> record.progress.verified;
    return record;
}

Status write_record(const FarmJob& job, const RoundRecord& record) {
    return write_file(
        job.folder + "/plan/round.txt",
        fmt::format(
            "{} {} {} {} {} {}\n", record.number, record.idle, record.progress.done,
            record.progress.attempts, record.progress.left_out, record.progress.verified));
}

/// The next round's groups; none after kIdleRounds that changed nothing.
Result<std::vector<FarmGroup>> begin_round(const FarmJob& job, std::string& name) {
    RoundRecord record = read_record(job);
    const JobProgress progress = measure(job);
    record.idle = record.number > 0 && progress == record.progress ? record.idle + 1 : 0;
    record.progress = progress;
    ++record.number;
    name = fmt::format("{:04}", record.number);
    LIMN_TRY(write_record(job, record));
    if (record.idle >= kIdleRounds || is_cancelled(job)) {
        return std::vector<FarmGroup>{};
    }
    std::vector<FarmGroup> groups = plan_round(job);
    if (record.idle > 0) {  // no other node could: any may
        for (FarmGroup& group : groups) {
            group.without.clear();
        }
    }
    return groups;
}

Status run_all_rounds(const FarmJob& job) {
    for (;;) {
        std::string name;
        const std::vector<FarmGroup> groups = LIMN_TRY(begin_round(job, name));
        if (groups.empty()) {
            return Done{};
        }
        for (std::size_t g = 0; g < groups.size() && !is_cancelled(job); ++g) {
            LIMN_TRY(run_parallel(job, fmt::format("{}_{}", name, g), groups[g]));
        }
        bury_dead_workers(job);
        // Frames of workers that are cut off are free only when those count as dead.
        while (has_workers(job) && !is_cancelled(job)) {
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            bury_dead_workers(job);
        }
    }
}

}  // namespace

std::vector<int> frames_to_verify(const FarmJob& job) {
    const double total = static_cast<double>(job.frames.size());
    const auto count = static_cast<std::size_t>(std::ceil(job.verify * total - 1e-9));
    std::vector<int> frames;
    for (std::size_t i = 0; i < count; ++i) {
        const double at = (static_cast<double>(i) + 0.5) * total / static_cast<double>(count);
        frames.push_back(job.frames[std::min(static_cast<std::size_t>(at), job.frames.size() - 1)]);
    }
    return frames;
}

std::vector<FarmGroup> plan_round(const FarmJob& job) {
    GroupMaker groups;
    std::vector<int> fresh;
    for (const FrameState& state : read_all_states(job)) {
        if (state.done || is_given_up(job, state)) {
            continue;
        }
        if (state.attempts.empty()) {
            fresh.push_back(state.frame);
        } else {
            groups.add(StateFile::Frame, failed_nodes(state), {state.frame});
        }
    }
    for (std::vector<int>& chunk : make_chunks(fresh, job.chunk, job.order)) {
        groups.add(StateFile::Frame, {}, std::move(chunk));
    }
    std::vector<FarmGroup> planned = groups.take();
    if (planned.empty()) {
        plan_verification(job, groups);
        planned = groups.take();
    }
    return planned;
}

std::string film_path(const FarmJob& job) {
    return (std::filesystem::path(job.folder) / job.film).lexically_normal().string();
}

Status make_job_film(const FarmJob& job) {
    std::vector<std::string> files;
    for (const int frame : job.frames) {
        files.push_back(frame_path(job, frame));
    }
    FilmSettings settings = job.film_settings;
    if (!settings.sound.empty()) {
        settings.sound = job.folder + "/inputs/" + settings.sound;
    }
    if (job.scene_sound) {
        const auto span = static_cast<std::size_t>(job.frames.back() - job.frames.front() + 1);
        settings.sound = span == job.frames.size() ? settings.sound : std::string();
        settings.sound_start = job.frames.front() / job.fps;
    }
    LIMN_TRY(check_film(film_path(job), settings));
    return make_film(files, film_path(job), settings, true);
}

bool is_coordinated(const FarmJob& job) {
    return find_coordinator(job).has_value() || is_queued(job);
}

Error job_is_taken(const FarmJob& job) {
    return fail(
        "{}: another process goes on with it; limn farm status shows how far it is", job.folder);
}

void forget_rounds(const FarmJob& job) {
    ::unlink((job.folder + "/result.json").c_str());
    ::unlink((job.folder + "/plan/round.txt").c_str());
}

Status run_rounds(const FarmJob& job) {
    forget_rounds(job);
    check_hosts(job);
    Status run = run_all_rounds(job);
    if (const Status space = check_space(job); !run && !space) {
        run = space;
    }
    const Status finished = finish_job(job, run ? "" : run.error().message);
    return run ? finished : run;
}

Status next_round(const FarmJob& job) {
    std::string name;
    const std::vector<FarmGroup> groups = LIMN_TRY(begin_round(job, name));
    if (groups.empty()) {
        return finish_job(job, {});
    }
    const Status queued = submit_slurm(job, name, groups);
    if (queued) {
        return queued;
    }
    const Status finished = finish_job(job, queued.error().message);
    cancel_slurm(job);  // what was queued before it failed, and this process where that is one
    return finished;
}

Status finish_job(const FarmJob& job, const std::string& why) {
    sweep(job);
    std::string failure = !why.empty()        ? why
                          : is_cancelled(job) ? fmt::format("{}: cancelled", job.folder)
                                              : failure_of(job, read_farm_status(job));
    if (failure.empty() && !job.film.empty()) {
        const Status film = make_film_apart(job);
        failure = film ? "" : film.error().message;
    }
    LIMN_TRY(write_file(
        job.folder + "/result.json",
        farm_json_text({{"done", failure.empty()}, {"failure", failure}})));
    return failure.empty() ? Status(Done{}) : Status(Error{failure});
}

}  // namespace limn
