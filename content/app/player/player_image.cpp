// What the window of `limn play` shows: the level, for a show with and without the technique, and
// the HUD.

#include "content/app/panels/emitter_controls.h"
#include "content/app/player/comparison_overlay.h"
#include "content/app/player/outline.h"
#include "content/app/player/path_overlay.h"
#include "content/app/player/player.h"
#include "content/bake/furrow_skin.h"
#include "content/game/stones.h"
#include "ecs/base/log.h"
#include "ecs/components/rendering.h"
#include "ecs/components/skin_pull.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "render/graph/frame_graph.h"
#include "render/particles/gpu_particle_pools.h"
#include "systems/animation/pose_keys_system.h"
#include "systems/animation/pose_system.h"
#include "systems/transform_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace limn {
namespace {

/// "wind 7.0 m/s from SW, rain 30 %"; empty if the level has no weather. -z is north.
std::string describe_weather(const World& world) {
    const auto* settings = world.find_resource<Weather>();
    const auto* state = world.find_resource<WeatherState>();
    if (settings == nullptr || state == nullptr) {
        return {};
    }
    const Weather weather = current_weather(*settings, *state);
    constexpr std::array kPoints = {"E", "SE", "S", "SW", "W", "NW", "N", "NE"};
    const float from = weather.wind_direction + kPi;
    const int point = static_cast<int>(std::lround(from / (kPi / 4))) % 8;
    std::string line = fmt::format(
        "wind {:.1f} m/s from {}", weather.wind_speed,
        kPoints[static_cast<std::size_t>((point + 8) % 8)]);
    if (weather.rain > 0) {
        line += fmt::format(", rain {:.0f} %", 100 * weather.rain);
    }
    return line;
}

/// Level of detail for the image's resolution. Needs the resource Rendering.
void fit_detail(World& world, float particle_share, int rows) {
    Rendering& rendering = world.resource<Rendering>();
    rendering.particle_share = std::min(rendering.particle_share, particle_share);
    rendering.level_rows = static_cast<float>(std::clamp(rows, 16, 16384));
}

/// Poses characters as they were edited, without velocity.
void pose_again(World& world) {
    world.run(add_pose_keys_states);
    world.run(release_pose_keys);
    world.run(prepare_pose_keys);
    world.run(update_poses);
    world.run(update_poses);
    world.run(update_attachments);
}

}  // namespace

void Player::draw_frame(float dt, const Input& input) {
    const IVec2 window_size = window_->framebuffer_size();
    if (window_size != last_window_size_) {
        last_window_size_ = window_size;
        if (!scale_.automatic) {
            scale_ =
                make_render_scale(options_.scale, false, device_->caps().software, window_size);
        }
    }
    const Clock::time_point begin = Clock::now();
    if (furrows_.is_open()) {
        stage_->world.run(update_furrow_skins);  // also while paused
    }
    skeleton_.record(stage_->world, stage_time(*stage_));
    if (skeleton_.poses() && paused_) {
        pose_again(stage_->world);  // at the time that the panel sets
    }
    show_edits();
    const IVec2 size = render_size(scale_, window_size);
    for (Stage* const played : {stage_.get(), off_stage_.get()}) {
        if (played != nullptr) {
            fit_detail(played->world, scale_.particle_share, size.y);
        }
    }
    view_ = move_camera(dt, input, size);
    if (exr_wanted_) {
        exr_wanted_ = false;
        save_exr(view_);
    }
    draw_stages(window_size);
    cost_.render_ms = seconds_between(begin, Clock::now()) * 1e3;
    if (screenshot_wanted_ && !screenshot_with_hud_) {
        screenshot_wanted_ = false;
        save_screenshot(window_size);
    }
    draw_hud(view_, window_size, dt);
}

void Player::request_next_renderer() {
    const std::vector<const RenderProfile*> all = profiles_->available();
    const auto at = std::ranges::find(all, profiles_->loaded());
    const bool last = at == all.end() || at + 1 == all.end();
    const RenderProfile& next = last ? *all.front() : **(at + 1);
    profiles_->request(next.name);
    hud_->toast(fmt::format("{}: {}", next.name, next.doc));
}

Status Player::follow_renderer() {
    const Result<bool> changed = profiles_->begin_frame();
    if (!changed) {
        log_error("{}", changed.error().message);
        hud_->toast(changed.error().message, ToastKind::Bad);
        LIMN_TRY(profiles_->load(profiles_->loaded() != nullptr ? profiles_->loaded()->name : ""));
    }
    if (!changed || *changed) {
        renderer_ = &profiles_->renderer();
        off_renderer_.reset();
        warm_up_level();
    }
    return Done{};
}

/// Shows edits since the last frame at once, also while paused.
void Player::show_edits() {
    const std::uint64_t revision = inspector_.undo_stack().revision();
    const bool inspected = std::exchange(shown_revision_, revision) != revision;
    if (!std::exchange(files_changed_, false) && !inspected) {
        return;
    }
    for (Stage* const played : {stage_.get(), off_stage_.get()}) {
        if (played != nullptr && paused_) {
            played->world.run(update_furrow_skins);
            pose_again(played->world);
            // Twice: what an edit moved must have no velocity.
            played->world.run(update_transforms);
            played->world.run(update_transforms);
        }
    }
    for (Renderer* const renderer : {renderer_, off_renderer_.get()}) {
        if (renderer != nullptr) {
            cut(*renderer);
        }
    }
}

/// The level, or the chosen sides of a show.
void Player::draw_stages(const IVec2& window_size) {
    const ShowSide side = off_stage_ != nullptr ? shows_.side : ShowSide::On;
    if (side != ShowSide::Off) {
        FrameGraph& graph = frame_graph(*renderer_);
        buffers_->before_frame(graph, request_);
        const FrameOutput frame = render_frame(*renderer_, stage_->world, view_, request_);
        buffers_->after_frame(*device_, graph, frame);
        gpu::blit_to_window(*device_, *frame.display, window_size.x, window_size.y);
        cost_.statistics = frame.statistics;
    }
    if (side != ShowSide::On) {
        const float width_fraction = side == ShowSide::Both ? shows_.divider : 1.0f;
        draw_off_stage(
            window_size,
            static_cast<int>(std::lround(width_fraction * static_cast<float>(window_size.x))));
    }
}

/// Draws the first `columns` of the window from the level without the technique.
void Player::draw_off_stage(const IVec2& window_size, int columns) {
    if (off_renderer_ == nullptr) {
        Result<RendererPtr> renderer =
            create_renderer(*device_, {.image = profiles_->loaded()->image()});
        if (!renderer) {
            log_error("{}", renderer.error().message);
            off_stage_ = nullptr;
            return;
        }
        off_renderer_ = *std::move(renderer);
    }
    const World& world = off_stage_->world;
    const Entity camera = off_stage_->scene.camera;
    RenderView view = view_;
    if (camera_.mode == CameraMode::Level) {
        view = make_render_view(world, camera, view_request_);
    } else {
        view.lens = lens_view(world, camera);
        view.entity = camera;
    }
    const FrameOutput frame =
        render_frame(*off_renderer_, world, view, {.aovs = {}, .paced = true});
    gpu::blit_to_window(*device_, *frame.display, window_size.x, window_size.y, columns);
    cost_.statistics = frame.statistics;
}

void Player::draw_hud(const RenderView& view, const IVec2& window_size, float dt) {
    FrameGraph& graph = frame_graph(*renderer_);
    device_->bind_window(window_size.x, window_size.y);
    hud_->begin_frame(dt);
    if (inspector_.open || (camera_.mode == CameraMode::Orbit && !stage_->scene.model)) {
        draw_outline(view);
    }
    if (paths_shown_) {
        draw_path_overlay(view, stage_->world);
    }
    skeleton_.draw_overlay(view, stage_->world);
    markers_.draw_overlay(view, stage_->world);
    draw_comparison_overlay(hud_->style(), stage_->world);
    const std::string weather = describe_weather(stage_->world);
    const std::string motion = describe_motion();
    detail_costs_.add(
        stage_->world.resource<Rendering>().surface_detail, profiler_.median_frame_ms(),
        {view.width, view.height}, dt);
    const std::string detail = detail_costs_.describe();
    const std::string drops = describe_drops(stage_->world);
    hud_->draw_status(
        {.level = (stage_->scene.title.empty() ? stage_->scene.name : stage_->scene.title).c_str(),
         .camera = camera_mode_name(camera_.mode),
         .weather = weather.c_str(),
         .detail = detail.c_str(),
         .drops = drops.c_str(),
         .time = shown_time_,
         .rate = rate_,
         .motion = motion.c_str(),
         .frame_ms = profiler_.median_frame_ms(),
         .render_size = {view.width, view.height},
         .window_size = window_size,
         .software_gl = device_->caps().software,
         .scale_auto = scale_.automatic,
         .particle_stride =
             static_cast<int>(particle_stride(stage_->world.resource<Rendering>().particle_share)),
         .paused = paused_,
         .error = (shader_error_.empty() ? level_error_ : shader_error_).c_str()});
    if (hud_->help_open) {
        hud_->help = player_help(stage_->world, help_state(), keys());
    }
    if (off_stage_ != nullptr && shows_.side == ShowSide::Both) {
        shows_.draw_divider(hud_->style());
    }
    shows_.draw(hud_->style(), options_.show);
    furrows_.draw(hud_->style(), stage_->world, inspector_.undo_stack());
    if (const std::string message = furrows_.take_message(); !message.empty()) {
        hud_->toast(message);
    }
    skeleton_.draw(hud_->style(), stage_->world, inspector_.undo_stack());
    if (const std::string message = skeleton_.take_message(); !message.empty()) {
        hud_->toast(message);
    }
    markers_.draw(hud_->style(), stage_->world);
    if (const std::string message = markers_.take_message(); !message.empty()) {
        hud_->toast(message);
    }
    model_panel_.draw(hud_->style(), stage_->world, level_cameras(), stage_->scene.camera);
    inspector_.draw(hud_->style(), stage_->world, stage_->schedule);
    profiler_.draw(hud_->style(), stage_->world, stage_->schedule, graph);
    buffers_->draw(hud_->style(), graph);
    leave_.draw(hud_->style(), inspector_, stage_->world);
    hud_->end_frame();
    device_->invalidate_state();
}

void Player::draw_outline(const RenderView& view) const {
    const World& world = stage_->world;
    const Bounds box = local_bounds(world, inspector_.selected());
    const WorldTransform* transform = world.find<WorldTransform>(inspector_.selected());
    if (is_empty(box) || transform == nullptr) {
        return;
    }
    const PreviousWorldTransform* previous =
        world.find<PreviousWorldTransform>(inspector_.selected());
    const Affine shown = world_at(
        world.find_resource<StepJumps>(), inspector_.selected(), *transform, previous,
        {view.alpha, view.alpha});
    draw_box_outline(view, shown, box);
}

/// "3.2 m/s  at 1.2, 0.5, -3.4"
std::string Player::describe_motion() const {
    const Vec3 position = transform_point(camera_.pose, {0, 0, 0});
    std::string text =
        fmt::format("at {:.1f}, {:.1f}, {:.1f} m", position.x, position.y, position.z);
    if (camera_.mode == CameraMode::Fly) {
        text += fmt::format("   flies {:.1f} m/s", camera_.fly.speed);
    } else if (camera_.mode == CameraMode::Orbit) {
        text += fmt::format("   {:.1f} m from the target", camera_.orbit.distance);
    }
    return text;
}

HelpState Player::help_state() const {
    const UndoStack& undo = inspector_.undo_stack();
    return {
        .camera = camera_.mode,
        .level_camera = stage_->scene.camera,
        .drives = driving_group(stage_->world, stage_->scene.camera) != nullptr,
        .throws = !std::as_const(stage_->world).query<const StoneThrower>().empty(),
        .paths = has_paths(stage_->world),
        .model = stage_->scene.model.has_value(),
        .show = off_stage_ != nullptr,
        .selected = stage_->world.alive(inspector_.selected()),
        .edited = undo.undo_count() + undo.redo_count() > 0,
        .inspector = inspector_.open,
        .furrows = furrows_.is_open(),
        .characters = !std::as_const(stage_->world).query<const Skeleton>().empty(),
        .skeleton = skeleton_.is_open(),
        .poses = skeleton_.poses(),
        .skin = !std::as_const(stage_->world).query<const PullableSkin>().empty(),
        .markers = markers_.has_take(),
        .places = markers_.is_open(),
        .panel =
            inspector_.open || profiler_.open || buffers_->open || shows_.open || model_panel_.open,
        .relief = has_relief(stage_->world)};
}

}  // namespace limn
