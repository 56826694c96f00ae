#include "content/app/farm/farm_worker.h"

#include "content/app/commands/compare_command.h"
#include "content/app/commands/image_file.h"
#include "content/app/farm/child_process.h"
#include "content/app/farm/farm_job.h"
#include "content/app/farm/frame_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <unistd.h>
#include <utility>

namespace limn {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds kPoll(200);
constexpr double kMaxPsnr = 999;  // [dB], of images that look equal: JSON has no infinity

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// The last lines of a log after its first `begin` bytes, as one.
std::string end_of_log(const std::string& path, std::uintmax_t begin) {
    constexpr std::size_t kLines = 3;
    std::ifstream file(path);
    file.seekg(static_cast<std::streamoff>(begin));
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);) {
        if (!line.empty()) {
            lines.push_back(line);
        }
    }
    std::string text;
    for (std::size_t i = lines.size() > kLines ? lines.size() - kLines : 0; i < lines.size(); ++i) {
        text += (text.empty() ? "" : " | ") + lines[i];
    }
    return text;
}

/// One run of the second process over the frames that are left.
class Drawing {
  public:
    Drawing(const FarmJob& job, const FarmWork& work, FarmWorker& worker, std::vector<int> frames)
        : job_(job), work_(work), worker_(worker), frames_(std::move(frames)),
          log_(worker.id + ".txt"), prefix_(fmt::format("{}/frames/.{}_", job.folder, worker.id)) {}

    /// Frames that are still to be drawn; a frame that failed is not among them.
    Result<std::vector<int>> run() {
        ChildProcess child = LIMN_TRY(ChildProcess::start(
            {.words = child_words(),
             .errors = job_.folder + "/log/" + log_,
             .folder = job_.folder + "/inputs",
             .environment = {},
             .without = {}}));
        Clock::time_point progress = Clock::now();
        Clock::time_point looked = Clock::now();
        while (!child.is_over() && reason_.empty()) {
            if (const auto line = child.read_line(kPoll)) {
                progress = Clock::now();
                LIMN_TRY(follow(*line));
            }
            peak_mib_ = std::max(peak_mib_, child.memory_mib());
            if (seconds_since(looked) > kAliveSeconds) {
                looked = Clock::now();
                cancelled_ = is_cancelled(job_);
            }
            if (cancelled_) {
                child.kill();
                break;
            }
            if (seconds_since(progress) > job_.timeout) {
                reason_ = fmt::format("no progress for {:.3g} s", job_.timeout);
            } else if (job_.memory_mib > 0 && peak_mib_ > job_.memory_mib) {
                reason_ = fmt::format(
                    "used {} MiB of memory, expected at most {} (--memory)", peak_mib_,
                    job_.memory_mib);
            }
        }
        if (!reason_.empty()) {
            child.kill();
        }
        finish(child.wait());
        return frames_;
    }
    [[nodiscard]] bool cancelled() const { return cancelled_; }

  private:
    std::vector<std::string> child_words() const {
        if (!job_.tasks.empty()) {
            std::vector<std::string> words = {program_path()};
            const std::vector<std::string>& task =
                job_.tasks[static_cast<std::size_t>(frames_.front())];
            words.insert(words.end(), task.begin(), task.end());
            words.insert(words.end(), {"--json", file_of(frames_.front())});
            return words;
        }
        return {program_path(), "farm", "draw", job_.folder, "--frames", write_frame_list(frames_),
                "--to",         prefix_};
    }

    std::string file_of(int frame) const { return prefix_ + numbered_path(job_.name, frame); }

    /// Lines of draw_farm_frames.
    Status follow(const std::string& line) {
        std::istringstream words(line);
        std::string word;
        int frame = -1;
        words >> word;
        if (word == "begin" && words >> frame) {
            if (begun_ == 0) {
                load_seconds_ = seconds_since(start_);
            }
            ++begun_;
            worker_.current = frame;
            return write_worker(job_, worker_);
        }
        if (word == "renderer") {
            std::getline(words >> std::ws, renderer_);
        }
        double seconds = 0;
        std::string world;
        if (word == "frame" && words >> frame >> seconds >> world) {
            return accept(frame, seconds, world);
        }
        return Done{};
    }

    /// Decodes the image; gives it its name, or notes why not.
    Status accept(int frame, double seconds, const std::string& world) {
        const std::string file = file_of(frame);
        const Result<FrameFile> image =
            job_.tasks.empty() ? read_frame_file(file, job_.size) : read_task_file(file);
        worker_.current = -1;
        if (!image) {
            LIMN_TRY(note(frame, seconds, image.error().message));
            forget(frame);
            return Done{};
        }
        FrameState state = read_frame_state(job_, frame, work_.kind);
        state.done = true;
        state.pixels = image->pixels;
        state.world = std::strtoull(world.c_str(), nullptr, 16);
        state.attempts.push_back(attempt(seconds, {}));
        if (work_.kind == StateFile::Frame) {
            std::error_code error;
            std::filesystem::rename(file, frame_path(job_, frame), error);
            if (error) {
                return fail("{}: {}", frame_path(job_, frame), error.message());
            }
        } else {
            if (read_frame_state(job_, frame).pixels != state.pixels) {
                const DisplayedDifference found =
                    LIMN_TRY(compare_displayed(frame_path(job_, frame), file));
                state.psnr = std::min(found.psnr, kMaxPsnr);
                state.largest = found.largest;
            }
            ::unlink(file.c_str());
        }
        LIMN_TRY(write_frame_state(job_, state, work_.kind));
        fmt::print("{}: {:.2f} s\n", numbered_path(job_.name, frame), seconds);
        std::fflush(stdout);
        forget(frame);
        return Done{};
    }

    FrameAttempt attempt(double seconds, const std::string& why) {
        FrameAttempt made;
        made.node = worker_.node;
        made.renderer = renderer_;
        made.seconds = seconds;
        made.load_seconds = std::exchange(load_seconds_, 0.0);
        made.peak_mib = peak_mib_;
        made.log = log_;
        made.why = why;
        return made;
    }

    Status note(int frame, double seconds, const std::string& why) {
        FrameState state = read_frame_state(job_, frame, work_.kind);
        state.done = false;
        state.attempts.push_back(attempt(seconds, why));
        note_failure(job_, worker_.node, frame);
        fmt::print("{}: failed: {}\n", numbered_path(job_.name, frame), why);
        std::fflush(stdout);
        return write_frame_state(job_, state, work_.kind);
    }

    void forget(int frame) {
        std::erase(frames_, frame);
        release_frame(job_, frame, work_.kind);
    }

    /// The process has ended: notes the frame at which, unless all are done.
    void finish(const ProcessEnd& end) {
        peak_mib_ = std::max(peak_mib_, end.peak_mib);
        if (!job_.tasks.empty() && end.status == 0 && reason_.empty() && !cancelled_) {
            const Status accepted = accept(frames_.front(), seconds_since(start_), "0");
            reason_ = accepted ? "" : accepted.error().message;
        }
        if (!frames_.empty() && !cancelled_
            && (end.status != 0 || !reason_.empty() || job_.tasks.empty())) {
            const int frame = worker_.current >= 0 ? worker_.current : frames_.front();
            const std::string log = end_of_log(job_.folder + "/log/" + log_, log_begin_);
            std::string why = reason_;
            if (why.empty() && end.signal != 0) {
                why = fmt::format(
                    "ended by signal {}{}, used {} MiB of memory", end.signal,
                    end.signal == 9 ? " (by hand, or too little memory)" : "", peak_mib_);
            }
            why += why.empty() || log.empty() ? log : ": " + log;
            why = why.empty() ? fmt::format("exit status {}", end.status) : why;
            const Status noted = note(frame, seconds_since(start_), why);
            static_cast<void>(noted);  // an unwritable folder: the caller's next write says so
            forget(frame);
        }
        worker_.current = -1;
        for (const int frame : worker_.chunk) {
            ::unlink(file_of(frame).c_str());
        }
    }

    const FarmJob& job_;
    const FarmWork& work_;
    FarmWorker& worker_;
    std::vector<int> frames_;
    std::string log_;
    std::uintmax_t log_begin_ = 0;  ///< what earlier processes of this worker printed [bytes]
    std::string prefix_;
    std::string renderer_;
    std::string reason_;  ///< why the process has to end
    Clock::time_point start_ = Clock::now();
    double load_seconds_ = 0;
    int begun_ = 0;
    int peak_mib_ = 0;
    bool cancelled_ = false;
};

/// Whether the frame is as its state says.
bool is_whole(const FarmJob& job, int frame, const FrameState& state, StateFile kind) {
    if (kind == StateFile::Verify || !state.done) {
        return state.done;
    }
    const Result<FrameFile> file = job.tasks.empty()
                                       ? read_frame_file(frame_path(job, frame), job.size)
                                       : read_task_file(frame_path(job, frame));
    return file && file->pixels == state.pixels;
}

/// The frames that are this worker's from now on.
std::vector<int>
claim_frames_of(const FarmJob& job, const FarmWork& work, const FarmWorker& worker) {
    std::vector<int> claimed;
    for (const int frame : work.frames) {
        if (!claim_frame(job, worker, frame, work.kind)) {
            continue;
        }
        const FrameState state = read_frame_state(job, frame, work.kind);
        if (is_whole(job, frame, state, work.kind) || is_given_up(job, state)) {
            release_frame(job, frame, work.kind);
        } else {
            claimed.push_back(frame);
        }
    }
    return claimed;
}

/// Draws the frames, after a failure those that are left.
Status draw_claimed(
    const FarmJob& job, const FarmWork& work, FarmWorker& worker, std::vector<int> frames) {
    while (!frames.empty() && !read_node(job, worker.node).left_out() && !is_cancelled(job)) {
        std::vector<int> chunk = frames;
        if (!job.tasks.empty()) {
            chunk.resize(1);
        }
        Drawing drawing(job, work, worker, chunk);
        const std::vector<int> left = LIMN_TRY(drawing.run());
        if (drawing.cancelled()) {
            return Done{};
        }
        std::erase_if(frames, [&](int frame) {
            const bool tried = std::ranges::find(chunk, frame) != chunk.end();
            return tried && std::ranges::find(left, frame) == left.end();
        });
    }
    return Done{};
}

/// Whether nothing is left that another node could do.
bool is_settled(const FarmJob& job, const FarmWork& work) {
    return std::ranges::all_of(work.frames, [&](int frame) {
        const FrameState state = read_frame_state(job, frame, work.kind);
        return state.done || is_given_up(job, state);
    });
}

}  // namespace

Result<int> run_farm_work(const FarmWork& work) {
    const FarmJob job = LIMN_TRY(load_farm_job(work.job));
    if (is_cancelled(job)) {
        return 1;
    }
    FarmWorker worker = make_worker(work.frames);
    if (const std::string difference = find_difference(job); !difference.empty()) {
        note_refusal(job, worker.node, difference);
        fmt::print(stderr, "{}: {}\n", worker.node, difference);
        return kTryElsewhere;
    }
    if (read_node(job, worker.node).left_out()) {
        fmt::print(stderr, "{}: left out, {} frames failed here\n", worker.node, kBadNodeFrames);
        return kTryElsewhere;
    }
    LIMN_TRY(write_worker(job, worker));
    const Heartbeat heartbeat(job, worker);
    const Status drawn = draw_claimed(job, work, worker, claim_frames_of(job, work, worker));
    remove_worker(job, worker);
    LIMN_TRY(drawn);
    return is_settled(job, work) ? 0 : kTryElsewhere;
}

}  // namespace limn
