#include "content/app/commands/render_command.h"

#include "content/app/commands/activity.h"
#include "content/app/commands/film_command.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/image_notes.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/render_frames.h"
#include "content/app/commands/render_record.h"
#include "content/load/files/image_load.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

namespace limn {
namespace {

/// Fails early, before hours of rendering, if the output folder does not exist.
Status check_folder(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        return fail("{}: found no folder {}, expected one", path, folder.string());
    }
    return Done{};
}

Status
write_frame(const FrameOutput& frame, const Stage& stage, double time, const std::string& path) {
    return write_image_file(path, frame, image_notes(stage, time));
}

/// The image at --time, or the show's.
Status render_still(RenderSession& session, const RenderOptions& options) {
    Stage& stage = *session.stage;
    const double time = options.time.value_or(stage.scene.show ? stage.scene.show->time : 0.0);
    if (options.samples == 0) {
        const Activity activity("drawing " + options.out, !options.quiet);
        const FrameOutput frame =
            draw_still(*session.headless.renderer, stage, session.camera, options, time);
        return write_frame(frame, stage, time, options.out);
    }
    Progress progress("sample", options.samples, !options.quiet);
    const FrameOutput frame = draw_sampled_still(
        session, options, time, [&progress](int samples) { progress.update(samples); });
    return write_frame(frame, stage, time, options.out);
}

/// All of --frames but those that are `done`.
Status render_range(
    RenderSession& session, const RenderOptions& options, const std::string& pattern,
    const std::vector<bool>& done) {
    Progress progress("frame", static_cast<int>(done.size()), !options.quiet);
    progress.update(0);
    const FrameEvents events = {
        .begin = [&](int frame) { progress.update(frame - options.frames->first); },
        .progress = {},
        .write =
            [&](int frame, const FrameOutput& image, double time) {
                return write_frame(image, *session.stage, time, numbered_path(pattern, frame));
            }};
    return render_frames(session, options, done, events);
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

/// The sounds of the scene while the film lasts, in a file beside its frames; empty: there are
/// none.
Result<std::string> mix_film_sound(const RenderSession& session, const RenderOptions& options) {
    const std::vector<SceneSound> sounds = stage_sounds(*session.stage);
    if (sounds.empty()) {
        return std::string();
    }
    const std::string path = (std::filesystem::path(frames_folder(options)) / "sound.wav").string();
    LIMN_TRY(save_wave(
        mix_sounds(
            sounds, options.frames->first / options.fps, (options.frames->last + 1) / options.fps),
        path));
    return path;
}

/// The frames that a stopped run left, then all others, then the film.
Status render_film(RenderSession& session, const RenderOptions& options) {
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
    LIMN_TRY(render_range(session, options, pattern, done));
    FilmSettings film = options.film;
    film.fps = options.fps;
    if (film.sound.empty() && film_kind(options.out) != FilmKind::Gif) {
        film.sound = LIMN_TRY(mix_film_sound(session, options));
    }
    const std::vector<std::string> files = LIMN_TRY(find_frame_files(pattern, options.frames));
    LIMN_TRY(make_film(files, options.out, film, options.quiet));
    if (!options.keep_frames) {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    return Done{};
}

Status draw_images(RenderSession& session, const RenderOptions& options) {
    if (!options.frames) {
        return render_still(session, options);
    }
    if (film_kind(options.out)) {
        return render_film(session, options);
    }
    const auto count = static_cast<std::size_t>(options.frames->last - options.frames->first + 1);
    return render_range(session, options, options.out, std::vector<bool>(count, false));
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
    RenderOptions found = options;
    found.scene = scene;
    std::optional<Activity> loading(std::in_place, "loading " + scene, !options.quiet);
    LIMN_TRY(check_folder(options.out));
    RenderSession session = LIMN_TRY(open_render(found));
    loading.reset();
    LIMN_TRY(draw_images(session, options));
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
