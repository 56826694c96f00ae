#include "content/app/farm/farm_check.h"

#include "content/app/farm/farm_json.h"
#include "content/app/farm/farm_state.h"
#include "content/app/farm/farm_status.h"
#include "content/app/farm/frame_file.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>

namespace limn {

namespace {

std::optional<FrameProblem> check_frame(const FarmJob& job, int frame) {
    const FrameState state = read_frame_state(job, frame);
    const std::string path = frame_path(job, frame);
    std::error_code ignored;
    if (!state.done) {
        return FrameProblem{
            frame, true,
            state.attempts.empty() ? "was not rendered" : "failed: " + state.attempts.back().why};
    }
    if (!std::filesystem::exists(path, ignored)) {
        return FrameProblem{frame, true, path + ": found no such file, expected it"};
    }
    const Result<FrameFile> file =
        job.tasks.empty() ? read_frame_file(path, job.size) : read_task_file(path);
    if (!file) {
        return FrameProblem{frame, false, file.error().message};
    }
    if (file->pixels != state.pixels) {
        return FrameProblem{
            frame, false,
            fmt::format(
                "{}: found pixels {:016x}, expected {:016x}", path, file->pixels, state.pixels)};
    }
    return std::nullopt;
}

}  // namespace

std::vector<FrameProblem> check_frames(const FarmJob& job) {
    std::vector<std::optional<FrameProblem>> found(job.frames.size());
    parallel_for(job.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            found[i] = check_frame(job, job.frames[i]);
        }
    });
    std::vector<FrameProblem> problems;
    for (std::optional<FrameProblem>& problem : found) {
        if (problem) {
            problems.push_back(*std::move(problem));
        }
    }
    return problems;
}

Status run_farm_check(const std::string& folder, bool json) {
    const FarmJob job = LIMN_TRY(load_farm_job(folder));
    const std::vector<FrameProblem> problems = check_frames(job);
    const FarmStatus status = read_farm_status(job);
    int bad_renderings = 0;
    for (const std::string& difference : status.differences) {
        bad_renderings += must_not_differ(difference) ? 1 : 0;
    }
    if (json) {
        FarmJson list = FarmJson::array();
        for (const FrameProblem& problem : problems) {
            list.push_back(
                {{"frame", problem.frame}, {"missing", problem.missing}, {"what", problem.what}});
        }
        const FarmJson object = FarmJson{
            {"job", job.folder},
            {"total", status.total},
            {"whole", status.total - static_cast<int>(problems.size())},
            {"problems", list},
            {"verified", status.verified},
            {"verified_bits", status.verified_bits},
            {"differences", status.differences}};
        fmt::print("{}", farm_json_text(object, 1));
    } else {
        for (const FrameProblem& problem : problems) {
            fmt::print("frame {}: {}\n", problem.frame, problem.what);
        }
        for (const std::string& difference : status.differences) {
            fmt::print("{}\n", difference);
        }
        fmt::print(
            "{}: {} of {} frames are whole", job.folder,
            status.total - static_cast<int>(problems.size()), status.total);
        fmt::print(
            "{}\n", status.verified == 0 ? ""
                                         : fmt::format(
                                             "; {} rendered twice, {} of them equal bit for bit",
                                             status.verified, status.verified_bits));
    }
    if (!problems.empty() || bad_renderings > 0) {
        return fail(
            "{}: {} frames are missing or damaged, {} renderings differ{}", job.folder,
            problems.size(), bad_renderings,
            status.suspect.empty() ? "" : ", most of them with " + status.suspect);
    }
    return Done{};
}

}  // namespace limn
