#include "content/app/player/play_command.h"

#include "content/app/commands/headless.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "content/app/player/player.h"
#include "content/app/player/window.h"
#include "content/load/level/level_list.h"
#include "ecs/base/text.h"
#include "ecs/world.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace limn {
namespace {

constexpr int kHeadlessFrames = 8;  // without a display
constexpr int kHeadlessSamples = 8;
constexpr double kStillDuration = 4.0;  // [s] for a scene without a camera path

/// "tour" if there is one, else the gallery, which shows a bit of everything.
std::string default_scene() {
    return find_level("tour") ? "tour" : "gallery";
}

Status play_headless(const PlayOptions& options, bool no_display) {
    Result<std::unique_ptr<Stage>> opened =
        open_stage(options.scene, {.show = {.technique = options.show}, .model = options.model});
    if (!opened) {
        return opened.error();
    }
    Stage& stage = **opened;
    const std::string folder = options.out.empty() ? "limn-" + stage.scene.name : options.out;
    std::error_code code;
    std::filesystem::create_directories(folder, code);
    if (code) {
        return fail("{}: found {}, expected a folder to write to", folder, code.message());
    }
    Result<HeadlessRenderer> headless =
        create_headless_renderer(options.profile, {}, options.renderer);
    if (!headless) {
        return headless.error();
    }
    if (const Status fits = check_image_size(*headless->device, options.size); !fits) {
        return fits.error();
    }
    fmt::print(
        "{}Rendering {} frame{} along the camera path of {} on {}.\n",
        no_display ? "There is no display, so no window is opened. " : "", options.headless_frames,
        options.headless_frames == 1 ? "" : "s", stage.scene.name,
        headless->device->caps().renderer);
    std::fflush(stdout);

    const double duration = stage.scene.duration > 0.0 ? stage.scene.duration : kStillDuration;
    Progress progress("frame", options.headless_frames);
    for (int i = 0; i < options.headless_frames; ++i) {
        const double time = duration * i / options.headless_frames;
        const float alpha = advance_stage(stage, time);
        const RenderView view = make_render_view(
            stage.world, stage.scene.camera,
            {.width = options.size.x,
             .height = options.size.y,
             .alpha = alpha,
             .previous_alpha = alpha - 1.0f});
        const FrameOutput frame = render_accumulated(
            *headless->renderer, stage.world, view, kHeadlessSamples, {}, SampleMean::Displayed);
        const std::string path =
            (std::filesystem::path(folder) / numbered_path("picture_%04d.png", i)).string();
        const Status written = write_image_file(path, frame);
        if (!written) {
            return written.error();
        }
        progress.update(i + 1);
    }
    fmt::print("The frames are in {}\n", std::filesystem::absolute(folder).string());
    return Done{};
}

}  // namespace

void set_antialiasing(World& world, Antialiasing wanted) {
    if (world.find_resource<Rendering>() == nullptr) {
        world.insert_resource(Rendering{});
    }
    Rendering& rendering = world.resource<Rendering>();
    if (wanted != Antialiasing::Auto) {
        rendering.antialiasing = wanted;
    } else if (rendering.antialiasing == Antialiasing::Auto) {
        rendering.antialiasing = Antialiasing::Temporal;
    }
}

Status run_play(const PlayOptions& given) {
    PlayOptions options = given;
    if (options.scene.empty()) {
        options.scene =
            options.show.empty() ? default_scene() : LIMN_TRY(find_show(options.show)).level.path;
    }
    const bool no_display = options.headless_frames == 0 && !Window::has_display();
    if (no_display) {
        options.headless_frames = kHeadlessFrames;
    }
    if (options.headless_frames > 0 && !options.markers.empty()) {
        return fail("--markers: found no window to click in, expected a display");
    }
    if (options.headless_frames > 0) {
        return play_headless(options, no_display);
    }
    Result<std::unique_ptr<Player>> player = Player::create(options);
    return player ? (*player)->run() : Status(player.error());
}

}  // namespace limn
