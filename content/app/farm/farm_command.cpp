#include "content/app/farm/farm_command.h"

#include "content/app/commands/command_options.h"
#include "content/app/commands/image_commands.h"
#include "content/app/commands/image_file.h"
#include "content/app/farm/farm_check.h"
#include "content/app/farm/farm_run.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <utility>

namespace limn {
namespace {

Result<double> parse_share(std::string_view text) {
    if (!text.empty() && text.back() == '%') {
        const double percent = LIMN_TRY(parse_number(text.substr(0, text.size() - 1), 0, 100));
        return percent / 100;
    }
    const Result<double> share = parse_number(text, 0, 1);
    return share ? share : fail("found {}, expected 0 to 1, or a percentage as 5%", text);
}

Result<FrameOrder> parse_order(std::string_view text) {
    if (text != "plain" && text != "preview") {
        return fail("found \"{}\", expected plain or preview", text);
    }
    return text == "plain" ? FrameOrder::Plain : FrameOrder::Preview;
}

/// What Ctrl-C does.
Result<bool> parse_interrupt(std::string_view text) {
    if (text != "detach" && text != "cancel") {
        return fail("found \"{}\", expected detach or cancel", text);
    }
    return text == "cancel";
}

void add_watching(CLI::App& app, bool& detach, bool& cancel_on_interrupt) {
    app.add_flag("--detach", detach, "return as soon as it has begun");
    add_parsed(
        app, "--interrupt", "what Ctrl-C does: the job goes on (detach) or ends; default: detach",
        cancel_on_interrupt, parse_interrupt)
        ->type_name("detach|cancel");
}

/// The options that were given, as words: those of `limn render` that a job keeps.
std::vector<std::string> given_words(const std::vector<const CLI::Option*>& options) {
    std::vector<std::string> words;
    for (const CLI::Option* const option : options) {
        if (option->count() == 0 || option->get_positional()) {
            continue;
        }
        const bool flag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->results()) {
            words.push_back(flag ? option->get_name() : option->get_name() + "=" + value);
        }
    }
    return words;
}

Status check_farm_options(const FarmOptions& options) {
    if (options.scheduler == FarmScheduler::Parallel && options.hosts.empty()) {
        return fail("found no --hosts, expected names for ssh; limn farm local needs none");
    }
    if (!options.tasks.empty() && options.verify > 0) {
        return fail("--verify: found it with a command, expected frames: times differ each time");
    }
    if (!options.tasks.empty()) {
        return Done{};
    }
    if (options.frames.empty()) {
        return fail("found no --frames, expected A:B, A:B:STEP or a list of these");
    }
    RenderOptions render = options.render;
    render.frames = FrameRange{options.frames.front(), options.frames.back()};
    if (options.frames.size() == 1 && !film_kind(render.out)) {
        const Result<bool> numbered = has_frame_number(render.out);
        if (numbered && !*numbered) {
            return fail("--out: found \"{}\", expected %05d in it", render.out);
        }
    }
    return check_render_options(render);
}

void add_start(
    CLI::App& farm, FarmOptions& options, const char* name, const char* doc,
    FarmScheduler scheduler) {
    CLI::App* app = farm.add_subcommand(name, doc);
    add_render_options(*app, options.render);
    const std::vector<const CLI::Option*> kept = std::as_const(*app).get_options();
    app->add_option("tasks", options.tasks, "after quality or bench: --all, and their options");
    app->add_option(
           "-o,--out", options.render.out,
           "frame_%05d.exr, frame_%05d.png, or a film; a folder before it is the job's")
        ->type_name("FILE");
    add_parsed(
        *app, "--frames", "A:B, A:B:STEP, or several with commas between", options.frames,
        parse_frame_list)
        ->type_name("LIST");
    app->add_option(
           "--job", options.folder, "folder of the job; default: that of --out, or SCENE.farm")
        ->type_name("FOLDER");
    add_integer(
        *app, "--chunk", "frames that a process renders; default: by their number", options.chunk,
        1, kMaxFrames);
    add_parsed(*app, "--order", "preview: every 16th frame first", options.order, parse_order)
        ->type_name("plain|preview");
    add_integer(*app, "--retries", "tries of a frame", options.retries, 1, 1000)->default_str("3");
    add_number(
        *app, "--timeout", "seconds without progress after which a frame is tried again",
        options.timeout, 1, 1e6)
        ->default_str("600");
    add_integer(
        *app, "--memory", "most memory of a process [MiB]; default: no limit", options.memory_mib,
        16, 1 << 24);
    add_integer(
        *app, "--slots",
        scheduler == FarmScheduler::Slurm
            ? "processes at a time; default: what the cluster has free"
            : "processes on a node; default: 2",
        options.slots, 1, 4096);
    add_parsed(
        *app, "--verify", "share of frames to render a second time, on another node",
        options.verify, parse_share)
        ->type_name("N%");
    if (scheduler == FarmScheduler::Parallel) {
        add_parsed(*app, "--hosts", "names for ssh; : is this machine", options.hosts, parse_list)
            ->type_name("A,B");
    }
    if (scheduler == FarmScheduler::Slurm) {
        app->add_option("--partition", options.partition, "of the cluster; default: its own");
    }
    add_watching(*app, options.detach, options.cancel_on_interrupt);
    app->callback([&options, kept, scheduler] {
        options.scheduler = scheduler;
        options.words = given_words(kept);
        if (!options.tasks.empty()) {
            options.tasks.insert(options.tasks.begin(), options.render.scene);
        }
        if (const Status status = check_farm_options(options); !status) {
            throw CLI::ValidationError(status.error().message);
        }
    });
}

CLI::App* add_job_command(
    CLI::App& farm, FarmJobOptions& options, const char* name, const char* doc, bool json) {
    CLI::App* app = farm.add_subcommand(name, doc);
    app->add_option("job", options.folder, "folder of a job")->type_name("JOB")->required();
    if (json) {
        app->add_flag("--json", options.json, "print JSON");
    }
    return app;
}

/// Commands that nodes run.
void add_node_commands(CLI::App& farm, FarmNodeOptions& options) {
    for (const char* const name : {"work", "draw", "coordinate", "next", "film"}) {
        CLI::App* app = farm.add_subcommand(name, "")->group("");
        app->add_option("job", options.folder)->required();
        app->add_option("--plan", options.plan);
        app->add_option("--line", options.line);
        add_parsed(*app, "--frames", "", options.frames, parse_frame_list);
        app->add_option("--to", options.prefix);
    }
}

Status run_work(const FarmNodeOptions& options) {
    const PlannedChunk chunk = LIMN_TRY(read_plan(options.plan, options.line));
    const int status = LIMN_TRY(
        run_farm_work({.job = options.folder, .frames = chunk.frames, .kind = chunk.kind}));
    if (status != 0) {
        std::exit(status);  // NOLINT(concurrency-mt-unsafe): nothing else runs
    }
    return Done{};
}

Status run_coordinator(const FarmJob& job) {
    const FarmWorker coordinator = make_worker({});
    if (!claim_job(job, coordinator)) {
        fmt::print(stderr, "{}\n", job_is_taken(job).message);
        std::exit(kJobIsTaken);  // NOLINT(concurrency-mt-unsafe): nothing else runs
    }
    const Heartbeat heartbeat(job, coordinator);
    const Status run = run_rounds(job);
    release_job(job, coordinator);
    return run;
}

Status run_node_command(const std::string& name, const FarmNodeOptions& options) {
    if (name == "work") {
        return run_work(options);
    }
    if (name == "draw") {
        return draw_farm_frames(options.folder, options.frames, options.prefix);
    }
    const FarmJob job = LIMN_TRY(load_farm_job(options.folder));
    if (name == "film") {
        return make_job_film(job);
    }
    return name == "coordinate" ? run_coordinator(job) : next_round(job);
}

Status run_chosen(const CLI::App& farm, const FarmCommandOptions& options) {
    const std::string name = farm.get_subcommands().front()->get_name();
    if (name == "status") {
        return run_farm_status(options.job);
    }
    if (name == "resume") {
        return run_farm_resume(options.job);
    }
    if (name == "cancel") {
        return run_farm_cancel(options.job);
    }
    if (name == "check") {
        return run_farm_check(options.job.folder, options.job.json);
    }
    if (name == "local" || name == "parallel" || name == "slurm") {
        return run_farm(options.start);
    }
    return run_node_command(name, options.node);
}

}  // namespace

Command add_farm(CLI::App& program, FarmCommandOptions& options) {
    CLI::App* farm = program.add_subcommand(
        "farm", "Render frames on many machines, or in many processes on this one");
    add_start(
        *farm, options.start, "local", "Render on this machine, by GNU Parallel",
        FarmScheduler::Local);
    add_start(
        *farm, options.start, "parallel", "Render on hosts that ssh reaches, by GNU Parallel",
        FarmScheduler::Parallel);
    add_start(
        *farm, options.start, "slurm", "Render on the nodes of a Slurm cluster",
        FarmScheduler::Slurm);
    add_job_command(*farm, options.job, "status", "Print how far a job is", true);
    CLI::App* resume = add_job_command(
        *farm, options.job, "resume", "Render what is missing, damaged or failed, and nothing else",
        false);
    add_parsed(*resume, "--frames", "more frames for the job", options.job.frames, parse_frame_list)
        ->type_name("LIST");
    add_watching(*resume, options.job.detach, options.job.cancel_on_interrupt);
    add_job_command(*farm, options.job, "cancel", "End all processes of a job", false);
    add_job_command(
        *farm, options.job, "check", "Decode all frames of a job, compare hashes", true);
    add_node_commands(*farm, options.node);
    farm->require_subcommand(1);
    farm->footer(
        "A job is a folder: job.json, the inputs as they were, frames, a small state file a "
        "frame,\n"
        "logs. All machines see it under the same path; all numbers come from its files.\n"
        "Frames are written under temporary names, decoded, and renamed when whole. One that "
        "fails\n"
        "is tried on another node; a node on which three frames failed is left out.\n"
        "limn farm local --help lists the options.\n\n"
        "Examples:\n"
        "  limn farm local gallery --frames 0:99 -o shot/frame_%05d.png --size 320x180\n"
        "  limn farm parallel gallery --frames 0:99 -o 'frame_%05d.exr' --hosts a,b\n"
        "  limn farm slurm gallery --frames 0:299 --fps 30 -o gallery.mp4 --verify 5%\n"
        "  limn farm local -- quality --all\n"
        "  limn farm status shot\n"
        "  limn farm resume shot\n"
        "  limn farm check shot");
    return {farm, [farm, &options] { return run_chosen(*farm, options); }};
}

}  // namespace limn
