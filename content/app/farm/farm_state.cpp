#include "content/app/farm/farm_state.h"

#include "content/app/farm/farm_job.h"
#include "content/app/farm/farm_json.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stop_token>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace limn {

namespace {

constexpr int kFolderFrames = 1000;  // frames a folder of state/

std::string state_folder(const FarmJob& job, int frame) {
    return fmt::format("{}/state/{:03}", job.folder, frame / kFolderFrames);
}

std::string state_path(const FarmJob& job, int frame, const char* ending) {
    return fmt::format("{}/{:07}.{}", state_folder(job, frame), frame, ending);
}

const char* ending_of(StateFile kind) {
    return kind == StateFile::Frame ? "json" : "verify";
}

const char* claim_of(StateFile kind) {
    return kind == StateFile::Frame ? "claim" : "verify_claim";
}

std::string worker_path(const FarmJob& job, const std::string& id) {
    return fmt::format("{}/workers/{}.json", job.folder, id);
}

/// The text of a small file; empty where it cannot be read.
std::string read_small_file(const std::string& path) {
    std::string text;
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    std::array<char, 4096> bytes{};
    for (ssize_t got = 0; file >= 0 && (got = ::read(file, bytes.data(), bytes.size())) > 0;) {
        text.append(bytes.data(), static_cast<std::size_t>(got));
    }
    if (file >= 0) {
        ::close(file);
    }
    return text;
}

/// Time of modification [s], by the file system; 0: no such file.
double modified_at(const std::string& path) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0) {
        return 0;
    }
    return static_cast<double>(status.st_mtim.tv_sec)
           + 1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
}

/// The file system's time now [s]; that of this machine where nothing can be written.
double time_of_files(const FarmJob& job) {
    const std::string path =
        fmt::format("{}/workers/.now.{}.{}", job.folder, node_name(), ::getpid());
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file >= 0) {
        ::close(file);
        const double now = modified_at(path);
        ::unlink(path.c_str());
        return now;
    }
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Whether a worker, `age` seconds after its last sign, can be taken for dead. On its own node it
/// is so as soon as its process has ended.
bool is_dead(const std::string& node, int pid, double age) {
    if (age > kDeadSeconds) {
        return true;
    }
    return node == node_name() && pid > 0 && ::kill(pid, 0) != 0 && errno == ESRCH;
}

FarmWorker read_worker(const FarmJob& job, const std::string& id, double now) {
    const std::string path = worker_path(job, id);
    const FarmJson object = read_farm_json(path);
    FarmWorker worker;
    worker.id = id;
    worker.node = member_or(object, "node", std::string());
    worker.pid = member_or(object, "pid", 0);
    worker.current = member_or(object, "current", -1);
    worker.chunk = member_or(object, "chunk", std::vector<int>{});
    worker.alive_seconds = now - modified_at(path);
    worker.dead = is_dead(worker.node, worker.pid, worker.alive_seconds);
    return worker;
}

/// Makes the folder of a frame's files if need be.
void make_state_folder(const FarmJob& job, int frame) {
    ::mkdir(state_folder(job, frame).c_str(), 0777);
}

std::vector<std::string> names_in(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        names.push_back(entry->path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

/// Puts a dead worker's claim in the hands of another. Of many that try, one succeeds: it alone has
/// the token meanwhile, and sees that the claim is still the dead one's.
bool inherit(const std::string& own, const std::string& path, const std::string& dead, double now) {
    const std::string token = path + ".token";
    if (::link(own.c_str(), token.c_str()) != 0) {
        const double made = modified_at(token);
        if (made > 0 && now - made > kDeadSeconds) {
            ::unlink(token.c_str());  // its owner died, too: next time
        }
        return false;
    }
    const bool inherited = member_or(read_farm_json(path), "worker", std::string()) == dead
                           && ::rename(own.c_str(), path.c_str()) == 0;
    ::unlink(token.c_str());
    return inherited;
}

/// Makes the file `path` name this worker, unless a living one has it.
bool claim(const FarmJob& job, const FarmWorker& worker, const std::string& path) {
    const std::string own = path + "." + worker.id;
    if (!write_file(own, farm_json_text({{"worker", worker.id}}))) {
        return false;
    }
    bool claimed = ::link(own.c_str(), path.c_str()) == 0;
    if (!claimed) {
        const double now = time_of_files(job);
        const double made = modified_at(path);
        const std::string holder = member_or(read_farm_json(path), "worker", std::string());
        if (made == 0) {  // given up meanwhile
            claimed = ::link(own.c_str(), path.c_str()) == 0;
        } else if (read_worker(job, holder, now).dead) {
            claimed = inherit(own, path, holder, now);
        }
    }
    ::unlink(own.c_str());
    return claimed;
}

/// A file of a node's folder.
void note_file(
    const FarmJob& job, const std::string& node, const std::string& name, const std::string& text) {
    const std::string folder = fmt::format("{}/nodes/{}", job.folder, node);
    ::mkdir(folder.c_str(), 0777);
    const Status noted = write_file(folder + "/" + name, text);
    static_cast<void>(noted);  // whatever it tells is in logs and states, too
}

FarmJson to_json(const FrameState& state) {
    FarmJson attempts = FarmJson::array();
    for (const FrameAttempt& attempt : state.attempts) {
        attempts.push_back(
            {{"node", attempt.node},
             {"renderer", attempt.renderer},
             {"seconds", attempt.seconds},
             {"load_seconds", attempt.load_seconds},
             {"peak_mib", attempt.peak_mib},
             {"log", attempt.log},
             {"why", attempt.why}});
    }
    return {
        {"frame", state.frame},
        {"done", state.done},
        {"pixels", fmt::format("{:016x}", state.pixels)},
        {"world", fmt::format("{:016x}", state.world)},
        {"psnr", state.psnr},
        {"largest", state.largest},
        {"attempts", attempts}};
}

std::uint64_t parse_hash(const std::string& text) {
    return std::strtoull(text.c_str(), nullptr, 16);
}

}  // namespace

FarmJson read_farm_json(const std::string& path) {
    FarmJson object = FarmJson::parse(read_small_file(path), nullptr, false);
    return object.is_object() ? object : FarmJson::object();
}

FrameState read_frame_state(const FarmJob& job, int frame, StateFile kind) {
    const FarmJson object = read_farm_json(state_path(job, frame, ending_of(kind)));
    FrameState state;
    state.frame = frame;
    state.pixels = parse_hash(member_or(object, "pixels", std::string()));
    state.world = parse_hash(member_or(object, "world", std::string()));
    state.psnr = member_or(object, "psnr", 0.0);
    state.largest = member_or(object, "largest", 0.0);
    for (const FarmJson& each : member_or(object, "attempts", FarmJson::array())) {
        if (each.is_object()) {
            state.attempts.push_back(
                {.node = member_or(each, "node", std::string()),
                 .renderer = member_or(each, "renderer", std::string()),
                 .seconds = member_or(each, "seconds", 0.0),
                 .load_seconds = member_or(each, "load_seconds", 0.0),
                 .peak_mib = member_or(each, "peak_mib", 0),
                 .log = member_or(each, "log", std::string()),
                 .why = member_or(each, "why", std::string())});
        }
    }
    state.done = member_or(object, "done", false) && !state.attempts.empty();
    return state;
}

std::vector<FrameState> read_all_states(const FarmJob& job) {
    std::vector<FrameState> states(job.frames.size());
    parallel_for(states.size(), kFolderFrames / 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            states[i] = read_frame_state(job, job.frames[i]);
        }
    });
    return states;
}

Status write_frame_state(const FarmJob& job, const FrameState& state, StateFile kind) {
    make_state_folder(job, state.frame);
    return write_file(
        state_path(job, state.frame, ending_of(kind)), farm_json_text(to_json(state)));
}

bool is_given_up(const FarmJob& job, const FrameState& state) {
    return !state.done && static_cast<int>(state.attempts.size()) >= job.retries;
}

std::vector<std::string> failed_nodes(const FrameState& state) {
    std::vector<std::string> nodes;
    for (const FrameAttempt& attempt : state.attempts) {
        if (!attempt.why.empty() && std::ranges::find(nodes, attempt.node) == nodes.end()) {
            nodes.push_back(attempt.node);
        }
    }
    return nodes;
}

FarmWorker make_worker(std::vector<int> chunk) {
    FarmWorker worker;
    worker.node = node_name();
    worker.pid = ::getpid();
    worker.id = fmt::format("{}.{}", worker.node, worker.pid);
    worker.chunk = std::move(chunk);
    return worker;
}

Status write_worker(const FarmJob& job, const FarmWorker& worker) {
    const FarmJson object = {
        {"node", worker.node},
        {"pid", worker.pid},
        {"current", worker.current},
        {"chunk", worker.chunk}};
    return write_file(worker_path(job, worker.id), farm_json_text(object));
}

Heartbeat::Heartbeat(const FarmJob& job, const FarmWorker& worker)
    : thread_([path = worker_path(job, worker.id)](const std::stop_token& stop) {
          std::mutex mutex;
          std::condition_variable_any wakes;
          std::unique_lock lock(mutex);
          while (!wakes.wait_for(lock, stop, std::chrono::duration<double>(kAliveSeconds), [&] {
              return stop.stop_requested();
          })) {
              ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
          }
      }) {}

void remove_worker(const FarmJob& job, const FarmWorker& worker) {
    for (const int frame : worker.chunk) {
        for (const StateFile kind : {StateFile::Frame, StateFile::Verify}) {
            if (member_or(
                    read_farm_json(state_path(job, frame, claim_of(kind))), "worker", std::string())
                == worker.id) {
                release_frame(job, frame, kind);
            }
        }
    }
    ::unlink(worker_path(job, worker.id).c_str());
}

std::vector<FarmWorker> list_workers(const FarmJob& job) {
    std::vector<FarmWorker> workers;
    const double now = time_of_files(job);
    for (const std::string& name : names_in(job.folder + "/workers")) {
        if (name.ends_with(".json") && name[0] != '.') {
            workers.push_back(read_worker(job, name.substr(0, name.size() - 5), now));
        }
    }
    return workers;
}

bool claim_frame(const FarmJob& job, const FarmWorker& worker, int frame, StateFile kind) {
    make_state_folder(job, frame);
    return claim(job, worker, state_path(job, frame, claim_of(kind)));
}

void release_frame(const FarmJob& job, int frame, StateFile kind) {
    ::unlink(state_path(job, frame, claim_of(kind)).c_str());
}

bool claim_job(const FarmJob& job, const FarmWorker& coordinator) {
    return write_worker(job, coordinator).ok()
           && claim(job, coordinator, job.folder + "/coordinator");
}

void release_job(const FarmJob& job, const FarmWorker& coordinator) {
    const std::string path = job.folder + "/coordinator";
    if (member_or(read_farm_json(path), "worker", std::string()) == coordinator.id) {
        ::unlink(path.c_str());
    }
    ::unlink(worker_path(job, coordinator.id).c_str());
}

std::optional<FarmWorker> find_coordinator(const FarmJob& job) {
    const std::string id =
        member_or(read_farm_json(job.folder + "/coordinator"), "worker", std::string());
    const FarmWorker coordinator = read_worker(job, id, time_of_files(job));
    return id.empty() || coordinator.dead ? std::nullopt : std::optional(coordinator);
}

void forget_frame(const FarmJob& job, int frame) {
    ::unlink(state_path(job, frame, ending_of(StateFile::Frame)).c_str());
    ::unlink(state_path(job, frame, ending_of(StateFile::Verify)).c_str());
}

void note_failure(const FarmJob& job, const std::string& node, int frame) {
    note_file(job, node, std::to_string(frame), {});
}

void note_refusal(const FarmJob& job, const std::string& node, const std::string& why) {
    note_file(job, node, "refused", why + "\n");
}

void bury_dead_workers(const FarmJob& job) {
    for (const FarmWorker& worker : list_workers(job)) {
        if (!worker.dead) {
            continue;
        }
        if (!worker.chunk.empty()) {
            note_file(job, worker.node, fmt::format("lost_{}", worker.pid), {});
        }
        ::unlink(worker_path(job, worker.id).c_str());  // its claims are void without it
    }
}

FarmNode read_node(const FarmJob& job, const std::string& name) {
    FarmNode node;
    node.name = name;
    const std::string folder = fmt::format("{}/nodes/{}", job.folder, name);
    for (const std::string& file : names_in(folder)) {
        if (file == "refused") {
            std::ifstream stream(folder + "/refused");
            std::getline(stream, node.refused);
        } else if (file.starts_with("lost_")) {
            ++node.lost;
        } else if (file.find_first_not_of("0123456789") == std::string::npos) {
            node.failed.push_back(std::atoi(file.c_str()));
        }
    }
    std::ranges::sort(node.failed);
    return node;
}

std::vector<FarmNode> list_nodes(const FarmJob& job) {
    std::vector<FarmNode> nodes;
    for (const std::string& name : names_in(job.folder + "/nodes")) {
        nodes.push_back(read_node(job, name));
    }
    return nodes;
}

bool is_cancelled(const FarmJob& job) {
    return ::access((job.folder + "/cancel").c_str(), F_OK) == 0;
}

}  // namespace limn
