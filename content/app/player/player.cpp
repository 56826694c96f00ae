#include "content/app/player/player.h"

#include "ecs/base/log.h"
#include "ecs/components/gpu_particles.h"
#include "render/graph/frame_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

// Techniques: engine.animate, engine.main-loop

namespace limn {
namespace {

constexpr int kMaxSteps = 4;             // per frame; beyond that, simulation time slows down
constexpr int kMaxHeardSteps = 30;       // the same while a sound is heard, which cannot slow down
constexpr double kMaxFrameTime = 0.25;   // [s] longer frames are clamped
constexpr double kShaderInterval = 0.5;  // [s] between checks of the shader and level files

}  // namespace

Player::Player(
    std::unique_ptr<Window> window, std::unique_ptr<gpu::Device> device, const PlayOptions& options)
    : options_(options), window_(std::move(window)), device_(std::move(device)) {
    hud_ = std::make_unique<Hud>(*window_);
    scale_ = make_render_scale(
        options.scale, options.scale_auto, device_->caps().software, window_->framebuffer_size());
}

Result<std::unique_ptr<Player>> Player::create(const PlayOptions& options) {
    Result<std::unique_ptr<Window>> window =
        Window::open({.size = options.size, .fullscreen = options.fullscreen});
    if (!window) {
        return window.error();
    }
    Result<std::unique_ptr<gpu::Device>> device =
        gpu::Device::from_current_context(options.profile);
    if (!device) {
        return device.error();
    }
    std::unique_ptr<Player> player(new Player(*std::move(window), *std::move(device), options));
    player->profiles_.emplace(*player->device_);
    LIMN_TRY(player->profiles_->load(options.renderer));
    player->renderer_ = &player->profiles_->renderer();
    Result<BufferViewer> buffers = BufferViewer::create(*player->device_);
    if (!buffers) {
        return buffers.error();
    }
    player->buffers_ = *std::move(buffers);
    const Status loaded = player->load(options.scene, options.show);
    if (!loaded) {
        return loaded.error();
    }
    if (!options.markers.empty()) {
        LIMN_TRY(player->markers_.load(options.markers, options.map));
        LIMN_TRY(player->open_markers());
    }
    if (player->device_->caps().software) {
        const IVec2 window_size = player->window_->framebuffer_size();
        const IVec2 size = render_size(player->scale_, window_size);
        const std::string resolution =
            player->scale_.automatic
                ? std::string("at a resolution that stays playable; --scale 1 for full resolution")
                : fmt::format("{} x {} pixels", size.x, size.y);
        log_info("{} renders on the CPU, {}", player->device_->caps().renderer, resolution);
    }
    return player;
}

/// While paused, shows the last state without interpolation: edits apply to that state, and nothing
/// else moves.
void Player::set_paused(bool paused) {
    paused_ = paused;
    unsimulated_ = paused ? 0.0 : stage_step(*stage_);
}

void Player::simulate(float dt, const Input& input) {
    const Clock::time_point begin = Clock::now();
    set_input(stage_->world, input);
    if (off_stage_ != nullptr) {
        set_input(off_stage_->world, input);
    }
    const double step = stage_step(*stage_);
    const double shown = stage_time(*stage_) - step + unsimulated_;
    const double correction = sound_.update(shown, !paused_);
    int steps = 0;
    if (!paused_) {
        unsimulated_ += std::max(dt + correction, 0.0);
        steps = static_cast<int>(unsimulated_ / step);
        unsimulated_ -= steps * step;
        steps = std::min(steps, sound_.is_heard() ? kMaxHeardSteps : kMaxSteps);
    } else if (step_once_) {
        steps = 1;
        unsimulated_ = 0.0;
    }
    step_once_ = false;
    simulated_seconds_ += steps * step;
    for (int i = 0; i < steps; ++i) {
        step_stage(*stage_);
        if (off_stage_ != nullptr) {
            step_stage(*off_stage_);
        }
    }
    const Entity camera = follow_active_camera(stage_->world, stage_->scene.camera);
    if (camera != stage_->scene.camera) {  // an event switched it
        stage_->scene.camera = camera;
        camera_.mode = CameraMode::Level;
    }
    follow_trial();
    cost_.simulate_ms = seconds_between(begin, Clock::now()) * 1e3;
}

void Player::set_input(World& world, const Input& input) const {
    Input* const resource = world.find_resource<Input>();
    if (resource == nullptr) {
        return;
    }
    take_input(*resource, input);
    const ActionGroup* const driver = driving_group(stage_->world, stage_->scene.camera);
    if (camera_.mode != CameraMode::Level && driver != nullptr) {
        for (const ActionInfo& action : driver->actions) {
            set_action(*resource, action.name, 0);  // these inputs move the camera
        }
        resource->look = Vec2(0);
    }
}

Status Player::run() {
    Clock::time_point last = Clock::now();
    bool quits = false;
    while (!quits) {
        const WindowEvents& events = window_->poll();
        for (const KeyPress& press : events.keys) {
            handle_key(press);
        }
        if (window_->framebuffer_size().x < 1 || window_->framebuffer_size().y < 1) {
            (void)sound_.update(0, false);
            window_->wait_events(0.1);  // minimized: nothing to draw on
            last = Clock::now();
            continue;
        }
        const Clock::time_point now = Clock::now();
        const double real = seconds_between(last, now);
        const float dt = static_cast<float>(std::min(real, kMaxFrameTime));
        last = now;

        if (window_->wants_to_close()) {  // by its button
            quits = inspector_.edit_count() == 0 && !markers_.has_unsaved();
            window_->request_close(false);
            if (!quits) {
                ask_to_quit();
            }
        }
        if (const std::function<void()> accepted = leave_.take_accepted()) {
            accepted();
            quits = window_->wants_to_close();
        }
        if (inspector_.take_step()) {
            step_once_ = true;
            paused_ = true;
        }
        if (const std::string message = inspector_.take_message(); !message.empty()) {
            hud_->toast(message);
        }
        if (inspector_.take_save() || leave_.take_save()) {
            save_edits();
        }
        if (inspector_.take_focus()) {
            focus_selection();
        }
        if (const std::string prefab = inspector_.take_placed(); !prefab.empty()) {
            place_prefab(prefab);
        }
        if (inspector_.take_furrows()) {
            edit_furrows();
        }
        if (inspector_.take_skeleton()) {
            skeleton_.open(find_character(stage_->world, inspector_.selected()));
        }
        if (furrows_.take_reset()) {
            face_furrows();
        }
        real_seconds_ += real;
        if (real_seconds_ >= 1.0) {
            rate_ = paused_ ? 1.0 : simulated_seconds_ / real_seconds_;
            real_seconds_ = simulated_seconds_ = 0.0;
        }
        pointer_taken_ = edit_by_pointer(events);
        if (events.left_clicked && !hud_->wants_mouse() && !pointer_taken_) {
            select_under_pointer();
        }
        if (events.double_clicked && !hud_->wants_mouse() && !pointer_taken_) {
            focus_under_pointer();
        }
        if (const std::optional<std::size_t> camera = model_panel_.take_camera()) {
            camera_.mode = CameraMode::Level;
            activate_camera(*camera);
        }
        if (const std::optional<FoundShow> selected = shows_.take_selected()) {
            leave_level([this, found = *selected] {
                load_or_report(found.level.path, found.show.technique);
            });
        }
        const Input input = read_input(events, dt);
        until_shader_check_ -= dt;
        if (until_shader_check_ <= 0.0) {
            until_shader_check_ = kShaderInterval;
            reload_shaders(false);
            follow_level_files();
            follow_sounds();
        }
        simulate(dt, input);
        LIMN_TRY(follow_renderer());
        draw_frame(dt, input);
        if (screenshot_wanted_) {
            screenshot_wanted_ = false;
            save_screenshot(window_->framebuffer_size());
        }
        window_->swap();

        cost_.frame_ms = real * 1e3;
        profiler_.add_frame(cost_);
        const double busy =
            std::max(cost_.simulate_ms + cost_.render_ms, frame_graph(*renderer_).total_gpu_ms());
        scale_.thins_particles =
            device_->caps().software && !stage_->world.query<const GpuParticles>().empty();
        update_render_scale(
            scale_, static_cast<float>(profiler_.median_frame_ms()), static_cast<float>(busy), dt);
    }
    return Done{};
}

}  // namespace limn
