#include "content/app/commands/image_commands.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/image_notes.h"
#include "content/app/commands/render_frames.h"
#include "content/app/farm/farm_job.h"
#include "content/app/farm/farm_worker.h"
#include "ecs/base/text.h"
#include "ecs/snapshot.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>

namespace limn {
namespace {

/// What `limn render` would be given for all frames of the job.
Result<RenderOptions> render_options_of(const FarmJob& job) {
    RenderOptions options;
    CLI::App app("render");
    add_render_options(app, options);
    std::vector<std::string> words(
        job.render.rbegin(), job.render.rend());  // CLI11 takes the last first
    try {
        app.parse(words);
    } catch (const CLI::Error& error) {
        return fail("{}/job.json: render: {}", job.folder, one_line(error.what()));
    }
    options.scene = job.folder + "/inputs/" + job.scene;
    options.size = job.size;
    options.fps = job.fps;
    options.frames = FrameRange{job.frames.front(), job.frames.back()};
    options.out = frame_path(job, job.frames.front());  // PNG or EXR
    options.quiet = true;
    return options;
}

void say(const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
}

}  // namespace

Status draw_farm_frames(
    const std::string& folder, const std::vector<int>& frames, const std::string& prefix) {
    const FarmJob job = LIMN_TRY(load_farm_job(folder));
    const RenderOptions options = LIMN_TRY(render_options_of(job));
    std::vector<bool> done(
        static_cast<std::size_t>(options.frames->last - options.frames->first + 1), true);
    for (const int frame : frames) {
        if (frame < options.frames->first || frame > options.frames->last) {
            return fail("--frames: found {}, expected {}", frame, write_frame_list(job.frames));
        }
        done[static_cast<std::size_t>(frame - options.frames->first)] = false;
    }
    RenderSession session = LIMN_TRY(open_render(options));
    warm_up_world(session.headless, session.stage->world, session.camera, options.size);
    say("renderer " + session.headless.device->caps().renderer);
    auto begin = std::chrono::steady_clock::now();
    const FrameEvents events = {
        .begin =
            [&](int frame) {
                begin = std::chrono::steady_clock::now();
                say(fmt::format("begin {}", frame));
            },
        .progress = [] { say("alive"); },
        .write = [&](int frame, const FrameOutput& image, double time) -> Status {
            LIMN_TRY(write_image_file(
                prefix + numbered_path(job.name, frame), image, image_notes(*session.stage, time)));
            const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
            say(fmt::format(
                "frame {} {:.4f} {:016x}", frame, seconds.count(),
                state_hash(session.stage->world)));
            return Done{};
        }};
    return render_frames(session, options, done, events);
}

}  // namespace limn
