#include "content/app/commands/render_command.h"

#include "content/app/commands/activity.h"
#include "content/app/commands/exposure_samples.h"
#include "content/app/commands/film_command.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/image_notes.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/render_record.h"
#include "content/app/commands/stage.h"
#include "content/load/files/image_load.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/name.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/rendering.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

// Techniques: post.distributed-sampling

namespace limn {
namespace {

constexpr int kTemporalFrames = 16;  ///< after which temporal antialiasing has converged

/// Motion blur modes that keep previous frames must keep whole frames, not antialiasing samples.
int played_samples(const World& world, const RenderOptions& options) {
    const auto* blur = world.find_resource<MotionBlur>();
    return blur != nullptr && needs_previous_frames(blur->mode) ? 1 : options.edge_samples;
}

/// The names of all cameras, for the error about an unknown one.
std::string camera_names(const World& world) {
    std::string names;
    world.query<const Name, const Camera>().each(
        [&](const Name& name, const Camera&) { names += (names.empty() ? "" : ", ") + name.text; });
    return names.empty() ? "no named camera" : names;
}

Result<Entity> choose_camera(const Stage& stage, const std::string& name) {
    if (name.empty()) {
        return stage.scene.camera;
    }
    if (const std::optional<Entity> camera = find_camera(stage.world, name)) {
        return *camera;
    }
    return fail(
        "{}: found no camera \"{}\", expected one of: {}", stage.scene.path, name,
        camera_names(stage.world));
}

/// Fails early, before hours of rendering, if the output folder does not exist.
Status check_folder(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        return fail("{}: found no folder {}, expected one", path, folder.string());
    }
    return Done{};
}

/// Simulation times of a frame and of the previous one [s].
struct FrameTimes {
    double shown = 0;
    double previous = 0;
};

/// Steps the simulation to the frame's time and returns the camera's view.
RenderView
advance_to_view(Stage& stage, Entity camera, const RenderOptions& options, const FrameTimes& time) {
    const float alpha = advance_stage(stage, time.shown);
    const double steps = (time.shown - time.previous) / stage_step(stage);
    return make_render_view(
        stage.world, camera,
        {.width = options.size.x,
         .height = options.size.y,
         .alpha = alpha,
         .previous_alpha = alpha - static_cast<float>(steps)});
}

/// Exposure time [s]: at most the time between frames.
double open_seconds(const World& world, const FrameTimes& time) {
    const auto* blur = world.find_resource<MotionBlur>();
    const double shutter_fraction =
        blur != nullptr ? static_cast<double>(blur->shutter) / 360.0 : 0.0;
    return std::clamp(shutter_fraction, 0.0, 1.0) * (time.shown - time.previous);
}

/// Renders the frame with the effects of `limn play`, antialiased by accumulation.
FrameOutput draw_played(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const FrameTimes& time) {
    const RenderView view = advance_to_view(stage, camera, options, time);
    return render_accumulated(
        renderer, stage.world, view, played_samples(stage.world, options), {.aovs = options.aovs});
}

/// Averages samples over shutter, lens and pixel while the simulation advances: the ground truth
/// that the real-time effects approximate. `progress`: counts the samples.
FrameOutput draw_sampled(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const FrameTimes& time, Progress* progress = nullptr) {
    const double open = open_seconds(stage.world, time);
    const float weight = 1.0f / static_cast<float>(options.samples);
    begin_accumulation(renderer, options.size, SampleKind::Instant);
    bool half_done = false;
    RenderView shown;
    for (int i = 0; i < options.samples; ++i) {
        const ExposureSample sample = exposure_sample(i, options.samples);
        const double sample_time = std::max(time.shown + sample.time * open, 0.0);
        if (!half_done && sample.time >= 0) {
            shown = advance_to_view(stage, camera, options, time);
            accumulate_aovs(renderer, stage.world, shown, {.aovs = options.aovs});
            half_done = true;
        }
        const RenderView view = advance_to_view(stage, camera, options, {sample_time, sample_time});
        accumulate(
            renderer, stage.world,
            with_lens_sample(
                with_jitter(view, sample.jitter), point_on_aperture(view.lens, sample.square)),
            weight);
        if (progress != nullptr) {
            progress->update(i + 1);
        }
    }
    return finish_accumulation(renderer, stage.world, shown);
}

/// Frames that particles with screen-space collision live, two seconds at most.
int depth_collision_frames(const World& world, double step) {
    constexpr double kLongest = 2;  // [s]
    double longest = 0;
    world.query<const ParticleEmitter, const ParticleCollision>().each(
        [&](const ParticleEmitter& emitter, const ParticleCollision& collision) {
            if (runs_on_gpu(emitter) && collision.collide_depth > 0) {
                longest =
                    std::max(longest, static_cast<double>(emitter.life + emitter.life_spread));
            }
        });
    return static_cast<int>(std::ceil(std::min(longest, kLongest) / step));
}

/// How many previous frames an image depends on.
int previous_frames(const World& world, double step) {
    const auto* const blur = world.find_resource<MotionBlur>();
    const auto* const rendering = world.find_resource<Rendering>();
    const bool averages = blur != nullptr && needs_previous_frames(blur->mode);
    const bool accumulates =
        rendering != nullptr && rendering->antialiasing == Antialiasing::Temporal;
    return std::max(
        {averages ? blur->window : 0, accumulates ? kTemporalFrames : 0,
         depth_collision_frames(world, step)});
}

Status
write_frame(const FrameOutput& frame, const Stage& stage, double time, const std::string& path) {
    return write_image_file(path, frame, image_notes(stage, time));
}

/// The image at --time, or the show's.
Status render_still(Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options) {
    const double time = options.time.value_or(stage.scene.show ? stage.scene.show->time : 0.0);
    if (options.samples == 0) {
        const Activity activity("drawing " + options.out, !options.quiet);
        const FrameOutput frame = draw_still(renderer, stage, camera, options, time);
        return write_frame(frame, stage, time, options.out);
    }
    Progress progress("sample", options.samples, !options.quiet);
    const FrameOutput frame =
        draw_sampled(renderer, stage, camera, options, {time, time - stage_step(stage)}, &progress);
    return write_frame(frame, stage, time, options.out);
}

/// Those of the frames that are to be drawn: all that are not `done`, and those on which they
/// depend.
std::vector<bool> frames_to_draw(const std::vector<bool>& done, int dependent) {
    std::vector<bool> drawn(done.size(), false);
    int wanted = 0;  // more frames before the one at hand
    for (std::size_t i = done.size(); i-- > 0;) {
        wanted = done[i] ? wanted - 1 : dependent;
        drawn[i] = !done[i] || wanted >= 0;
    }
    return drawn;
}

/// All of --frames but those that are `done`.
Status render_range(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const std::string& pattern, const std::vector<bool>& done) {
    const auto drawn = frames_to_draw(done, previous_frames(stage.world, 1 / options.fps));
    Progress progress("frame", static_cast<int>(done.size()), !options.quiet);
    progress.update(0);
    for (std::size_t i = 0; i < done.size(); ++i) {
        const int frame = options.frames->first + static_cast<int>(i);
        const FrameTimes time = {frame / options.fps, (frame - 1) / options.fps};
        if (drawn[i]) {
            const FrameOutput output = options.samples > 0
                                           ? draw_sampled(renderer, stage, camera, options, time)
                                           : draw_played(renderer, stage, camera, options, time);
            if (!done[i]) {
                LIMN_TRY(write_frame(output, stage, time.shown, numbered_path(pattern, frame)));
            }
        }
        progress.update(static_cast<int>(i + 1));
    }
    return Done{};
}

/// Where the images of a film are while it is made.
std::string frames_folder(const RenderOptions& options) {
    return options.out + ".frames";
}

/// Whether the file is a whole image of that size.
bool is_whole_frame(const std::string& path, const IVec2& size) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return false;
    }
    const Result<ImageData> image = load_image(path, true);
    return image && image->width == size.x && image->height == size.y;
}

/// The frames that a stopped run left, then all others, then the film.
Status render_film(Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options) {
    const std::filesystem::path folder = frames_folder(options);
    const std::string pattern = (folder / "frame_%05d.png").string();
    std::vector<bool> done;
    for (int frame = options.frames->first; frame <= options.frames->last; ++frame) {
        done.push_back(is_whole_frame(numbered_path(pattern, frame), options.size));
    }
    const auto left = std::ranges::count(done, true);
    if (left > 0 && !options.quiet) {
        fmt::print("{}: {} of {} frames are there already\n", folder.string(), left, done.size());
    }
    LIMN_TRY(render_range(renderer, stage, camera, options, pattern, done));
    FilmSettings film = options.film;
    film.fps = options.fps;
    const std::vector<std::string> files = LIMN_TRY(find_frame_files(pattern, options.frames));
    LIMN_TRY(make_film(files, options.out, film, options.quiet));
    if (!options.keep_frames) {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    return Done{};
}

Status draw_images(Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options) {
    if (!options.frames) {
        return render_still(renderer, stage, camera, options);
    }
    if (film_kind(options.out)) {
        return render_film(renderer, stage, camera, options);
    }
    const auto count = static_cast<std::size_t>(options.frames->last - options.frames->first + 1);
    return render_range(
        renderer, stage, camera, options, options.out, std::vector<bool>(count, false));
}

/// Before anything is loaded.
Status prepare_film(const RenderOptions& options) {
    LIMN_TRY(check_film(options.out, options.film));
    const std::filesystem::path folder = frames_folder(options);
    std::error_code error;
    std::filesystem::create_directory(folder, error);
    if (error) {
        return fail("{}: {}", folder.string(), error.message());
    }
    return claim_frames((folder / "render.txt").string(), describe_render(options));
}

Status check_film_render(const RenderOptions& options) {
    if (!options.frames) {
        return fail("--out: found \"{}\", expected --frames with a film", options.out);
    }
    if (!options.aovs.empty()) {
        return fail("--aov: found \"{}\", expected images of EXR with it", options.out);
    }
    return Done{};
}

}  // namespace

FrameOutput draw_still(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options, double time) {
    const double step = stage_step(stage);
    const auto draw_at = [&](double when) {
        const RenderView view = advance_to_view(stage, camera, options, {when, when - step});
        (void)render_frame(renderer, stage.world, view);
    };
    if (time > 0 && !stage.world.query<const EnvProbe>().empty()) {
        draw_at(0);
    }
    for (int i = previous_frames(stage.world, step); i > 0; --i) {
        if (time - i * step >= stage_time(stage)) {
            draw_at(time - i * step);
        }
    }
    return draw_played(renderer, stage, camera, options, {time, time - step});
}

Status check_render_options(const RenderOptions& options) {
    if (options.scene.empty() && options.show.technique.empty()) {
        return fail("found no scene, expected SCENE or --show ID");
    }
    if (options.show.off && options.show.technique.empty()) {
        return fail("found --off alone, expected --show ID with it");
    }
    if (film_kind(options.out)) {
        return check_film_render(options);
    }
    const Result<ImageFileKind> kind = image_file_kind(options.out);
    if (!kind) {
        return fail("--out: {}", kind.error().message);
    }
    if (options.keep_frames || !options.film.sound.empty()) {
        return fail(
            "--out: found \"{}\", expected a film with --keep-frames and --sound", options.out);
    }
    const Result<bool> numbered = has_frame_number(options.out);
    if (!numbered) {
        return fail("--out: {}", numbered.error().message);
    }
    if (options.frames && !*numbered && options.frames->first != options.frames->last) {
        return fail("--out: found \"{}\", expected %04d in it for --frames", options.out);
    }
    if (!options.frames && *numbered) {
        return fail("--out: found \"{}\", expected --frames with it", options.out);
    }
    if (!options.aovs.empty() && *kind != ImageFileKind::Exr) {
        return fail("--aov: found \"{}\", expected a name that ends in .exr with it", options.out);
    }
    for (const std::string& aov : options.aovs) {
        const std::vector<std::string_view>& names = aov_names();
        if (std::find(names.begin(), names.end(), aov) == names.end()) {
            return fail("--aov: found \"{}\", expected some of {}", aov, join_text(names, " "));
        }
    }
    return Done{};
}

Status run_render(const RenderOptions& options) {
    const auto begin = std::chrono::steady_clock::now();
    const std::string scene = !options.scene.empty()
                                  ? options.scene
                                  : LIMN_TRY(find_show(options.show.technique)).level.path;
    if (film_kind(options.out)) {
        LIMN_TRY(prepare_film(options));
    }
    std::optional<Activity> loading(std::in_place, "loading " + scene, !options.quiet);
    const std::unique_ptr<Stage> opened = LIMN_TRY(open_stage(
        scene, {.seed = options.seed,
                .assignments = options.assignments,
                .show = options.show,
                .model = options.model}));
    Stage& stage = *opened;
    const Entity camera = LIMN_TRY(choose_camera(stage, options.camera));
    LIMN_TRY(check_folder(options.out));
    HeadlessRenderer headless = LIMN_TRY(create_headless_renderer(options.profile));
    LIMN_TRY(check_image_size(*headless.device, options.size));
    loading.reset();
    LIMN_TRY(draw_images(*headless.renderer, stage, camera, options));
    if (!options.quiet) {
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const std::string frames =
            options.frames ? fmt::format("{} x ", options.frames->last - options.frames->first + 1)
                           : "";
        fmt::print(
            "{}: {}{}x{}, {:.1f} s\n", options.out, frames, options.size.x, options.size.y,
            seconds);
    }
    return Done{};
}

}  // namespace limn
