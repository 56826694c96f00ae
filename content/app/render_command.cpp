#include "content/app/render_command.h"

#include "content/app/headless.h"
#include "content/app/picture_file.h"
#include "content/app/progress.h"
#include "content/app/stage.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"
#include "ecs/components/name.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace limn {
namespace {

/// The names of all cameras, for the error about one that is not there.
std::string camera_names(const World& world) {
    std::string names;
    world.query<const Name, const Camera>().each(
        [&](const Name& name, const Camera&) { names += (names.empty() ? "" : ", ") + name.text; });
    return names.empty() ? "no camera with a name" : names;
}

Result<Entity> choose_camera(const Stage& stage, const std::string& name) {
    if (name.empty()) {
        return stage.scene.camera;
    }
    if (const std::optional<Entity> camera = find_camera(stage.world, name)) {
        return *camera;
    }
    return fail(
        "{}: found no camera \"{}\", expected one of: {}",
        stage.scene.path,
        name,
        camera_names(stage.world));
}

/// Fails before hours of rendering if the first picture could not be written.
Status check_folder(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        return fail("{}: found no folder {}, expected one", path, folder.string());
    }
    return Done{};
}

/// One picture of the moment `time`; `before` is the moment its motion is measured from.
Status render_picture(
    HeadlessRenderer& headless,
    Stage& stage,
    Entity camera,
    const RenderOptions& options,
    double time,
    double before,
    const std::string& path) {
    const float alpha = advance_stage(stage, time);
    const double step = stage_step(stage);
    const RenderView view = make_render_view(
        stage.world,
        camera,
        {.width = options.size.x,
         .height = options.size.y,
         .alpha = alpha,
         .alpha_before = alpha - static_cast<float>((time - before) / step)});
    const FrameOutput frame = render_accumulated(
        *headless.renderer, stage.world, view, options.samples, {.aovs = options.aovs});
    return write_picture(
        path, frame, {{"limn.scene", stage.scene.name}, {"limn.time", fmt::format("{}", time)}});
}

}  // namespace

Status check_render_options(const RenderOptions& options) {
    const Result<PictureKind> kind = picture_kind(options.out);
    if (!kind) {
        return fail("--out: {}", kind.error().message);
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
    if (!options.aovs.empty() && *kind != PictureKind::Exr) {
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
    Result<std::unique_ptr<Stage>> opened =
        open_stage(options.scene, options.seed, options.assignments);
    if (!opened) {
        return opened.error();
    }
    Stage& stage = **opened;
    const Result<Entity> camera = choose_camera(stage, options.camera);
    if (!camera) {
        return camera.error();
    }
    const Status folder = check_folder(options.out);
    if (!folder) {
        return folder.error();
    }
    Result<HeadlessRenderer> headless = create_headless_renderer();
    if (!headless) {
        return headless.error();
    }
    if (const Status fits = check_picture_size(*headless->device, options.size); !fits) {
        return fits.error();
    }
    if (!options.frames) {
        const double step = stage_step(stage);
        return render_picture(
            *headless, stage, *camera, options, options.time, options.time - step, options.out);
    }
    const int count = options.frames->last - options.frames->first + 1;
    Progress progress("frame", count);
    for (int i = 0; i < count; ++i) {
        const int frame = options.frames->first + i;
        const Status status = render_picture(
            *headless,
            stage,
            *camera,
            options,
            frame / options.fps,
            (frame - 1) / options.fps,
            numbered_path(options.out, frame));
        if (!status) {
            return status.error();
        }
        progress.update(i + 1);
    }
    return Done{};
}

}  // namespace limn
