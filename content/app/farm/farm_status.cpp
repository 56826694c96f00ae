#include "content/app/farm/farm_status.h"

#include "content/app/farm/farm_json.h"
#include "content/app/farm/farm_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace limn {

namespace {

constexpr double kLoadShare = 0.1;  // of a chunk's time, at a good size

constexpr double kSamePicture = 40;  // [dB] between renderers that may round otherwise

using NodesByName = std::map<std::string, NodeStatus>;

NodeStatus& node_of(NodesByName& nodes, const std::string& name) {
    NodeStatus& node = nodes[name];
    node.node.name = name;
    return node;
}

/// Sums over frames that are done.
struct Sums {
    double seconds = 0;
    double load_seconds = 0;
    int loads = 0;
};

void count_done(const FrameState& state, NodesByName& nodes, Sums& sums) {
    const FrameAttempt& last = state.attempts.back();
    NodeStatus& node = node_of(nodes, last.node);
    ++node.done;
    node.seconds += last.seconds;
    node.renderer = last.renderer;
    sums.seconds += last.seconds;
    if (last.load_seconds > 0) {
        sums.load_seconds += last.load_seconds;
        ++sums.loads;
    }
}

/// How a second rendering compares with the first; empty: equal bit for bit.
std::string compare_renderings(const FrameState& first, const FrameState& second) {
    const FrameAttempt& a = first.attempts.back();
    const FrameAttempt& b = second.attempts.back();
    const std::string where = fmt::format("frame {}: {} and {}", first.frame, a.node, b.node);
    if (first.world != second.world) {
        return where + ": found other states of the simulation, expected the same";
    }
    if (first.pixels == second.pixels) {
        return {};
    }
    const std::string found = fmt::format(
        "pixels {:.1f} dB from each other, at most {:.4f}", second.psnr, second.largest);
    if (a.renderer == b.renderer) {
        return fmt::format("{}: found {}, expected the same bits ({})", where, found, a.renderer);
    }
    if (second.psnr < kSamePicture) {
        return fmt::format(
            "{}: found {}, expected {} dB or more ({} and {})", where, found, kSamePicture,
            a.renderer, b.renderer);
    }
    return fmt::format("{}: {}, as they may be ({} and {})", where, found, a.renderer, b.renderer);
}

/// The name with the highest count, if it is the only one.
std::string most_frequent(const std::map<std::string, int>& counts) {
    int highest = 0;
    std::string name;
    for (const auto& [each, count] : counts) {
        name = count > highest ? each : count == highest ? "" : name;
        highest = std::max(highest, count);
    }
    return name;
}

/// Frames and nodes from the files of workers.
void count_workers(const FarmJob& job, FarmStatus& status, NodesByName& nodes) {
    for (const FarmWorker& worker : list_workers(job)) {
        if (worker.node.empty() || worker.chunk.empty()) {  // the one that starts others
            continue;
        }
        NodeStatus& node = node_of(nodes, worker.node);
        if (worker.dead) {
            ++node.node.lost;
            continue;
        }
        if (worker.current >= 0) {
            node.drawing.push_back(worker.current);
        } else {
            node.loading = true;
        }
        if (worker.current < 0 || !read_frame_state(job, worker.current).done) {
            ++status.running;
        }
    }
    status.running = std::min(status.running, status.total - status.done - status.failed);
}

void estimate(const Sums& sums, FarmStatus& status) {
    if (status.done == 0) {
        return;
    }
    status.frame_seconds = sums.seconds / status.done;
    status.load_seconds = sums.loads > 0 ? sums.load_seconds / sums.loads : 0;
    status.good_chunk = static_cast<int>(std::clamp(
        std::ceil(
            status.load_seconds * (1 - kLoadShare) / kLoadShare
            / std::max(status.frame_seconds, 1e-6)),
        1.0, 10000.0));
    const double loads = static_cast<double>(sums.loads) / status.done;
    if (status.running > 0) {
        status.left_seconds = (status.frame_seconds + loads * status.load_seconds)
                              * (status.waiting() + 0.5 * status.running) / status.running;
    }
}

std::string duration(double seconds) {
    const auto whole = static_cast<long>(std::lround(seconds));
    if (whole >= 3600) {
        return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
    }
    return whole >= 60 ? fmt::format("{}:{:02} min", whole / 60, whole % 60)
                       : fmt::format("{:.1f} s", seconds);
}

std::string describe_node(const NodeStatus& node) {
    std::string text = fmt::format("  {:<12} {:>6} done", node.node.name, node.done);
    if (node.done > 0) {
        text += fmt::format(", {:.2f} s a frame", node.seconds / node.done);
    }
    if (!node.drawing.empty()) {
        text += fmt::format(", draws {}", fmt::join(node.drawing, " "));
    } else if (node.loading) {
        text += ", loads";
    }
    if (!node.node.failed.empty()) {
        text += fmt::format(", failed {}", fmt::join(node.node.failed, " "));
    }
    if (node.node.lost > 0) {
        text += fmt::format(", {} processes lost", node.node.lost);
    }
    if (!node.node.refused.empty()) {
        text += "; left out: " + node.node.refused;
    } else if (node.node.left_out()) {
        text += fmt::format("; left out: {} frames failed there", node.node.failed.size());
    }
    return text + (node.renderer.empty() ? "" : "  [" + node.renderer + "]") + "\n";
}

/// Lines of the first frames.
std::string describe_failures(const std::vector<FailedFrame>& frames, const char* verb) {
    constexpr std::size_t kShown = 10;
    std::string text;
    for (std::size_t i = 0; i < std::min(frames.size(), kShown); ++i) {
        const FailedFrame& frame = frames[i];
        text += fmt::format(
            "  frame {}: {} {} {}, on {}: {}\n", frame.frame, verb, frame.tries,
            frame.tries == 1 ? "time" : "times", fmt::join(frame.nodes, ", "), frame.why);
    }
    return frames.size() > kShown
               ? text + fmt::format("  and {} more (--json lists all)\n", frames.size() - kShown)
               : text;
}

FarmJson failures_json(const std::vector<FailedFrame>& frames) {
    FarmJson list = FarmJson::array();
    for (const FailedFrame& frame : frames) {
        list.push_back(
            {{"frame", frame.frame},
             {"tries", frame.tries},
             {"nodes", frame.nodes},
             {"why", frame.why}});
    }
    return list;
}

}  // namespace

bool must_not_differ(const std::string& difference) {
    return difference.find("expected") != std::string::npos;
}

FarmStatus read_farm_status(const FarmJob& job) {
    FarmStatus status;
    status.total = static_cast<int>(job.frames.size());
    NodesByName nodes;
    Sums sums;
    for (const FrameState& state : read_all_states(job)) {
        for (const FrameAttempt& attempt : state.attempts) {
            int& peak = node_of(nodes, attempt.node).peak_mib;
            peak = std::max(peak, attempt.peak_mib);
        }
        if (state.done) {
            ++status.done;
            count_done(state, nodes, sums);
        } else if (!state.attempts.empty()) {
            const bool given_up = is_given_up(job, state);
            status.failed += given_up ? 1 : 0;
            (given_up ? status.given_up : status.to_retry)
                .push_back(
                    {state.frame, static_cast<int>(state.attempts.size()), failed_nodes(state),
                     state.attempts.back().why});
        }
    }
    const std::vector<int> twice = frames_to_verify(job);
    status.to_verify = static_cast<int>(twice.size());
    std::map<std::string, int> differing;  // renderings by node
    for (const int frame : twice) {
        const FrameState first = read_frame_state(job, frame);
        const FrameState second = read_frame_state(job, frame, StateFile::Verify);
        if (first.done && second.done) {
            ++status.verified;
            status.verified_here +=
                first.attempts.back().node == second.attempts.back().node ? 1 : 0;
            const std::string difference = compare_renderings(first, second);
            status.verified_bits += difference.empty() ? 1 : 0;
            if (!difference.empty()) {
                status.differences.push_back(difference);
            }
            if (must_not_differ(difference)) {
                ++differing[first.attempts.back().node];
                ++differing[second.attempts.back().node];
            }
        }
    }
    status.suspect = most_frequent(differing);
    for (const FarmNode& node : list_nodes(job)) {
        node_of(nodes, node.name).node = node;
    }
    count_workers(job, status, nodes);
    estimate(sums, status);
    status.cancelled = is_cancelled(job);
    status.coordinated = is_coordinated(job);
    for (auto& [name, node] : nodes) {
        status.nodes.push_back(std::move(node));
    }
    return status;
}

std::string summarize_status(const FarmJob& job, const FarmStatus& status) {
    std::string text = fmt::format(
        "{} of {} {} done, {} running, {} failed, {} waiting", status.done, status.total,
        job.tasks.empty() ? "frames" : "tasks", status.running, status.failed, status.waiting());
    if (status.done > 0) {
        text += fmt::format(
            "; {:.2f} s a {}", status.frame_seconds, job.tasks.empty() ? "frame" : "task");
    }
    if (status.left_seconds >= 0) {
        text += ", " + duration(status.left_seconds) + " left";
    }
    return text;
}

std::string describe_status(const FarmJob& job, const FarmStatus& status) {
    std::string text = job.folder + ": " + summarize_status(job, status) + "\n";
    if (status.load_seconds > 0) {
        text +=
            fmt::format("  loading takes {:.2f} s a chunk of {}", status.load_seconds, job.chunk);
        text += status.good_chunk > job.chunk
                    ? fmt::format("; --chunk {} would make it a tenth\n", status.good_chunk)
                    : "\n";
    }
    for (const NodeStatus& node : status.nodes) {
        text += describe_node(node);
    }
    text += describe_failures(status.given_up, "failed");
    text += describe_failures(status.to_retry, "has failed");
    if (status.to_verify > 0) {
        text += fmt::format(
            "  rendered twice: {} of {}, {} of them equal bit for bit{}\n", status.verified,
            status.to_verify, status.verified_bits,
            status.verified_here > 0 ? fmt::format(", {} on the same node", status.verified_here)
                                     : "");
    }
    for (const std::string& difference : status.differences) {
        text += "  " + difference + "\n";
    }
    if (!status.suspect.empty()) {
        text += "  most of these are with " + status.suspect + ": look there first\n";
    }
    if (status.cancelled) {
        text += "  cancelled; limn farm resume goes on\n";
    } else if (!status.coordinated && status.done + status.failed < status.total) {
        text += "  nothing goes on with it; limn farm resume does\n";
    }
    return text;
}

std::string status_json(const FarmJob& job, const FarmStatus& status) {
    FarmJson nodes = FarmJson::array();
    for (const NodeStatus& node : status.nodes) {
        nodes.push_back(
            {{"name", node.node.name},
             {"renderer", node.renderer},
             {"done", node.done},
             {"seconds", node.seconds},
             {"peak_mib", node.peak_mib},
             {"drawing", node.drawing},
             {"loading", node.loading},
             {"failed", node.node.failed},
             {"lost", node.node.lost},
             {"left_out", node.node.left_out()},
             {"refused", node.node.refused}});
    }
    const FarmJson object = {
        {"job", job.folder},
        {"total", status.total},
        {"done", status.done},
        {"running", status.running},
        {"failed", status.failed},
        {"waiting", status.waiting()},
        {"frame_seconds", status.frame_seconds},
        {"load_seconds", status.load_seconds},
        {"left_seconds", status.left_seconds},
        {"chunk", job.chunk},
        {"good_chunk", status.good_chunk},
        {"cancelled", status.cancelled},
        {"coordinated", status.coordinated},
        {"nodes", nodes},
        {"given_up", failures_json(status.given_up)},
        {"to_retry", failures_json(status.to_retry)},
        {"to_verify", status.to_verify},
        {"verified", status.verified},
        {"verified_here", status.verified_here},
        {"verified_bits", status.verified_bits},
        {"differences", status.differences},
        {"suspect", status.suspect}};
    return farm_json_text(object, 1);
}

}  // namespace limn
