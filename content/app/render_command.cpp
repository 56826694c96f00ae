#include "content/app/render_command.h"

#include "content/app/exposure_samples.h"
#include "content/app/headless.h"
#include "content/app/picture_file.h"
#include "content/app/progress.h"
#include "content/app/stage.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/name.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace limn {
namespace {

constexpr int kPlayedSamples = 16;  ///< of a pixel's edges

/// What keeps pictures keeps whole ones.
int played_samples(const World& world) {
    const auto* blur = world.find_resource<MotionBlur>();
    return blur != nullptr && keeps_pictures(blur->mode) ? 1 : kPlayedSamples;
}

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
        "{}: found no camera \"{}\", expected one of: {}", stage.scene.path, name,
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

/// The moment a picture shows and the one of the picture before it [s].
struct PictureTime {
    double shown = 0;
    double before = 0;
};

/// What the camera sees, after the steps up to the moment shown.
RenderView advance_to_view(
    Stage& stage, Entity camera, const RenderOptions& options, const PictureTime& time) {
    const float alpha = advance_stage(stage, time.shown);
    const double steps = (time.shown - time.before) / stage_step(stage);
    return make_render_view(
        stage.world, camera,
        {.width = options.size.x,
         .height = options.size.y,
         .alpha = alpha,
         .alpha_before = alpha - static_cast<float>(steps)});
}

/// How long the shutter is open [s]: as long as it can be before it opens for the next picture.
double open_seconds(const World& world, const PictureTime& time) {
    const auto* blur = world.find_resource<MotionBlur>();
    const double share = blur != nullptr ? static_cast<double>(blur->shutter) / 360.0 : 0.0;
    return std::clamp(share, 0.0, 1.0) * (time.shown - time.before);
}

/// As it is played, its edges made smooth.
FrameOutput draw_played(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const PictureTime& time) {
    const RenderView view = advance_to_view(stage, camera, options, time);
    return render_accumulated(
        renderer, stage.world, view, played_samples(stage.world), {.aovs = options.aovs});
}

/// The mean of samples of shutter, lens and pixel, while the world goes on: the truth that the
/// effects of the played picture come near.
FrameOutput draw_sampled(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const PictureTime& time) {
    const double open = open_seconds(stage.world, time);
    const float weight = 1.0f / static_cast<float>(options.samples);
    begin_accumulation(renderer, options.size, SampleKind::Instant);
    bool half_done = false;
    RenderView shown;
    for (int i = 0; i < options.samples; ++i) {
        const ExposureSample sample = exposure_sample(i, options.samples);
        const double moment = std::max(time.shown + sample.moment * open, 0.0);
        if (!half_done && sample.moment >= 0) {
            shown = advance_to_view(stage, camera, options, time);
            accumulate_aovs(renderer, stage.world, shown, {.aovs = options.aovs});
            half_done = true;
        }
        const RenderView view = advance_to_view(stage, camera, options, {moment, moment});
        accumulate(
            renderer, stage.world,
            with_lens_sample(
                with_jitter(view, sample.jitter), point_on_aperture(view.lens, sample.square)),
            weight);
    }
    return finish_accumulation(renderer, stage.world, shown);
}

Status render_picture(
    HeadlessRenderer& headless, Stage& stage, Entity camera, const RenderOptions& options,
    const PictureTime& time, const std::string& path) {
    const FrameOutput frame = options.samples > 0
                                  ? draw_sampled(*headless.renderer, stage, camera, options, time)
                                  : draw_played(*headless.renderer, stage, camera, options, time);
    return write_picture(
        path, frame,
        {{"limn.scene", stage.scene.name}, {"limn.time", fmt::format("{}", time.shown)}});
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
            *headless, stage, *camera, options, {options.time, options.time - step}, options.out);
    }
    const int count = options.frames->last - options.frames->first + 1;
    Progress progress("frame", count);
    for (int i = 0; i < count; ++i) {
        const int frame = options.frames->first + i;
        const Status status = render_picture(
            *headless, stage, *camera, options, {frame / options.fps, (frame - 1) / options.fps},
            numbered_path(options.out, frame));
        if (!status) {
            return status.error();
        }
        progress.update(i + 1);
    }
    return Done{};
}

}  // namespace limn
