#include "content/app/player.h"

#include "content/app/outline.h"
#include "content/app/path_overlay.h"
#include "content/app/pick.h"
#include "content/load/level_list.h"
#include "ecs/base/log.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "render/gpu_particle_pools.h"
#include "render/graph/frame_graph.h"
#include "systems/transform_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

namespace limn {
namespace {

constexpr int kMaxSteps = 4;             // per frame; beyond that, simulation time slows down
constexpr double kMaxFrameTime = 0.25;   // [s] longer frames are clamped
constexpr double kPickInterval = 0.15;   // [s] between measurements of the distance ahead
constexpr double kShaderInterval = 0.5;  // [s] between checks of the shader and level files

double seconds_between(
    std::chrono::steady_clock::time_point begin, std::chrono::steady_clock::time_point end) {
    return std::chrono::duration<double>(end - begin).count();
}

/// "wind 7.0 m/s from SW, rain 30 %"; nothing where a level has no weather. -z is north.
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

/// Played frames are antialiased unless the player or the level says how.
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

/// The world has Rendering, by set_antialiasing().
void limit_particles(World& world, float share) {
    Rendering& rendering = world.resource<Rendering>();
    rendering.particle_share = std::min(rendering.particle_share, share);
}

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
    Result<RendererPtr> renderer = create_renderer(*player->device_);
    if (!renderer) {
        return renderer.error();
    }
    player->renderer_ = *std::move(renderer);
    Result<BufferViewer> buffers = BufferViewer::create(*player->device_);
    if (!buffers) {
        return buffers.error();
    }
    player->buffers_ = *std::move(buffers);
    const Status loaded = player->load(options.scene, options.show);
    if (!loaded) {
        return loaded.error();
    }
    if (player->device_->caps().software) {
        const IVec2 window_size = player->window_->framebuffer_size();
        const IVec2 size = render_size(player->scale_, window_size);
        const std::string resolution =
            player->scale_.automatic
                ? std::string("at a resolution that keeps it playable; --scale 1 for the full one")
                : fmt::format("{} x {} pixels", size.x, size.y);
        log_info("{} renders on the CPU, {}", player->device_->caps().renderer, resolution);
    }
    return player;
}

// ---- levels -------------------------------------------------------------------------------------

Status Player::load(const std::string& scene, const std::string& show) {
    draw_loading(scene);
    std::unique_ptr<Stage> stage = LIMN_TRY(open_stage(
        scene,
        {.show = {.technique = show, .off = false}, .made = &made_, .model = options_.model}));
    std::unique_ptr<Stage> off;
    if (!show.empty()) {
        off =
            LIMN_TRY(open_stage(scene, {.show = {.technique = show, .off = true}, .made = &made_}));
        advance_stage(*stage, stage->scene.show->time);
        advance_stage(*off, stage->scene.show->time);
    }
    stage_ = std::move(stage);
    off_stage_ = std::move(off);
    off_renderer_ = nullptr;
    first_camera_ = stage_->scene.camera;
    options_.scene = scene;
    options_.show = show;
    level_times_ = level_file_times();
    level_error_.clear();
    inspector_.reset();
    camera_ = {};
    const Bounds& bounds = stage_->scene.bounds;
    if (!is_empty(bounds)) {
        camera_.reach = std::clamp(0.3f * glm::length(half_extent(bounds)), 0.5f, 50.0f);
    }
    paused_ = false;
    rate_ = 1.0;
    real_seconds_ = simulated_seconds_ = 0.0;
    scale_.particle_share = 1;
    for (Stage* const played : {stage_.get(), off_stage_.get()}) {
        if (played != nullptr) {
            set_antialiasing(played->world, options_.antialiasing);
        }
    }
    unsimulated_ = 0.0;
    shown_time_ = stage_time(*stage_);
    model_panel_.open =
        stage_->scene.model && ModelPanel::has_choices(stage_->world, level_cameras());
    window_->set_title(fmt::format("{} - Limn", stage_->scene.name));
    warm_up_level();
    return Done{};
}

/// Compiles the level's shaders, so that its frames need not.
void Player::warm_up_level() {
    const IVec2 size = render_size(scale_, window_->framebuffer_size());
    const RenderView view = make_render_view(
        stage_->world, stage_->scene.camera,
        {.width = std::max(size.x, 1), .height = std::max(size.y, 1)});
    warm_up(*renderer_, stage_->world, view, [this](int done, int total) {
        draw_loading(
            options_.scene, fmt::format("compiling shaders, view {} of {}", done + 1, total));
    });
}

void Player::draw_loading(const std::string& scene, const std::string& step) {
    const IVec2 size = window_->framebuffer_size();
    device_->bind_window(size.x, size.y);
    glClearColor(0.02f, 0.02f, 0.025f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    hud_->draw_loading(std::filesystem::path(scene).filename().string(), step);
    device_->invalidate_state();
    window_->swap();
}

void Player::load_or_report(const std::string& scene, const std::string& show) {
    const Status status = load(scene, show);
    if (!status) {
        log_error("{}", status.error().message);
        hud_->toast(status.error().message, ToastKind::Bad);
    }
}

void Player::load_neighbor(int offset) {
    const std::vector<LevelEntry> levels = list_levels();
    if (levels.empty()) {
        return;
    }
    const int count = static_cast<int>(levels.size());
    int index = offset > 0 ? -1 : 0;
    for (int i = 0; i < count; ++i) {
        index = levels[static_cast<std::size_t>(i)].name == stage_->scene.name ? i : index;
    }
    const LevelEntry& next = levels[static_cast<std::size_t>((index + offset + count) % count)];
    options_.model = {};
    load_or_report(next.name);
    hud_->toast(next.title.empty() ? next.name : next.title);
}

void Player::leave_level(std::function<void()> action, const char* verb) {
    if (inspector_.edit_count() == 0) {
        action();
        return;
    }
    leave_.ask(fmt::format("{} {}?", verb, stage_->scene.name), verb, std::move(action));
}

void Player::ask_to_quit() {
    leave_.ask("Quit Limn?", "Quit", [this] { window_->request_close(); });
}

// ---- a frame ------------------------------------------------------------------------------------

void Player::simulate(float dt, const Input& input) {
    const Clock::time_point begin = Clock::now();
    set_input(stage_->world, input);
    if (off_stage_ != nullptr) {
        set_input(off_stage_->world, input);
    }
    const double step = stage_step(*stage_);
    int steps = 0;
    if (!paused_) {
        unsimulated_ += dt;
        steps = static_cast<int>(unsimulated_ / step);
        unsimulated_ -= steps * step;
        steps = std::min(steps, kMaxSteps);
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
    cost_.simulate_ms = seconds_between(begin, Clock::now()) * 1e3;
}

void Player::set_input(World& world, const Input& input) const {
    Input* const resource = world.find_resource<Input>();
    if (resource == nullptr) {
        return;
    }
    const bool waiting = resource->click;  // until a step has seen it: a frame may run none
    *resource = input;
    resource->click = input.click || waiting;
    const ActionGroup* const driver = driving_group(stage_->world, stage_->scene.camera);
    if (camera_.mode != CameraMode::Level && driver != nullptr) {
        for (const ActionInfo& action : driver->actions) {
            set_action(*resource, action.name, 0);  // these inputs move the camera
        }
        resource->look = Vec2(0);
    }
}

RenderView Player::move_camera(float dt, const Input& input, const IVec2& size) {
    const double step = stage_step(*stage_);
    // Right after loading there is only one state, nothing to interpolate.
    const double steps_done = stage_time(*stage_) / step;
    const float alpha =
        paused_ && unsimulated_ == 0.0 ? 1.0f : static_cast<float>(unsimulated_ / step);
    const double shown = steps_done < 0.5 ? 0.0 : stage_time(*stage_) - step + alpha * step;
    const ViewRequest request{
        .width = size.x,
        .height = size.y,
        .alpha = alpha,
        .previous_alpha =
            alpha - static_cast<float>(std::clamp((shown - shown_time_) / step, 0.0, 8.0))};
    view_request_ = request;
    shown_time_ = shown;

    const Entity level_camera = stage_->scene.camera;
    const Camera* lens = std::as_const(stage_->world).find<Camera>(level_camera);
    camera_.lens = lens != nullptr ? *lens : camera_.lens;
    camera_.previous = camera_.pose;
    if (camera_.mode == CameraMode::Level && lens != nullptr) {
        const RenderView view = make_render_view(stage_->world, level_camera, request);
        camera_.pose = view.world_from_camera;
        camera_.started = true;
        return view;
    }
    if (camera_.mode == CameraMode::Orbit) {
        const Vec3 target =
            entity_middle(stage_->world, camera_.orbit.target).value_or(camera_.aim);
        step_orbit(camera_, camera_input(input), target, dt);
    } else {
        fly(dt, input);
    }
    RenderView view = make_render_view(camera_.lens, camera_.pose, camera_.previous, request);
    view.lens = lens_view(stage_->world, level_camera);
    view.entity = level_camera;
    return view;
}

void Player::fly(float dt, const Input& input) {
    const MoveInput move = camera_input(input);
    const World& world = stage_->world;
    until_pick_ -= static_cast<double>(dt);
    if (until_pick_ <= 0.0) {
        until_pick_ = kPickInterval;
        const std::optional<Hit> hit = pick_entity(world, ray_through(view_, {0.5f, 0.5f}));
        ahead_ = hit ? hit->distance : INFINITY;
    }
    const Bounds& bounds = stage_->scene.bounds;
    const float radius = is_empty(bounds) ? 10.0f : glm::length(half_extent(bounds));
    follow_reach(camera_, ahead_, radius, dt);
    step_fly(camera_, move, dt);
    const Vec3 before = transform_point(camera_.previous, {0, 0, 0});
    if (move.move.y >= 0 && camera_.place.position.y < before.y) {
        const std::optional<Hit> floor = pick_entity(world, {before, {0, -1, 0}});
        stop_at_floor(camera_, floor ? std::optional(floor->distance) : std::nullopt);
    }
}

/// "3.2 m/s  at 1.2, 0.5, -3.4"
std::string Player::describe_motion() const {
    const Vec3 place = transform_point(camera_.pose, {0, 0, 0});
    std::string text = fmt::format("at {:.1f}, {:.1f}, {:.1f} m", place.x, place.y, place.z);
    if (camera_.mode == CameraMode::Fly) {
        text += fmt::format("   flies {:.1f} m/s", camera_.fly.speed);
    } else if (camera_.mode == CameraMode::Orbit) {
        text += fmt::format("   {:.1f} m from the target", camera_.orbit.distance);
    }
    return text;
}

HelpState Player::help_state() const {
    return {
        .camera = camera_.mode,
        .level_camera = stage_->scene.camera,
        .drives = driving_group(stage_->world, stage_->scene.camera) != nullptr,
        .model = stage_->scene.model.has_value(),
        .show = off_stage_ != nullptr,
        .inspector = inspector_.open,
        .panel = inspector_.open || profiler_.open || buffers_->open || shows_.open
                 || model_panel_.open};
}

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
    for (Stage* const played : {stage_.get(), off_stage_.get()}) {
        if (played != nullptr) {
            limit_particles(played->world, scale_.particle_share);
        }
    }
    const IVec2 size = render_size(scale_, window_size);
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

/// The level, or of a show what is chosen of it.
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
        const float share = side == ShowSide::Both ? shows_.divider : 1.0f;
        draw_off_stage(
            window_size, static_cast<int>(std::lround(share * static_cast<float>(window_size.x))));
    }
}

/// Draws the first `columns` of the window from the level without the technique.
void Player::draw_off_stage(const IVec2& window_size, int columns) {
    if (off_renderer_ == nullptr) {
        Result<RendererPtr> renderer = create_renderer(*device_);
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
    const FrameOutput frame = render_frame(*off_renderer_, world, view);
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
    const std::string weather = describe_weather(stage_->world);
    const std::string motion = describe_motion();
    hud_->draw_status(
        {.level = (stage_->scene.title.empty() ? stage_->scene.name : stage_->scene.title).c_str(),
         .camera = camera_mode_name(camera_.mode),
         .weather = weather.c_str(),
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
        hud_->help = player_help(stage_->world, help_state());
    }
    if (off_stage_ != nullptr && shows_.side == ShowSide::Both) {
        shows_.draw_divider(hud_->style());
    }
    shows_.draw(hud_->style(), options_.show);
    model_panel_.draw(hud_->style(), stage_->world, level_cameras(), stage_->scene.camera);
    inspector_.draw(hud_->style(), stage_->world, stage_->schedule);
    const std::uint64_t revision = inspector_.undo_stack().revision();
    if (std::exchange(shown_revision_, revision) != revision && paused_) {
        // What was moved is shown where it is now. Twice: it has not moved since the last frame.
        stage_->world.run(update_transforms);
        stage_->world.run(update_transforms);
    }
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
    const Affine shown = previous != nullptr
                             ? mix_affine(previous->world, transform->world, view.alpha)
                             : transform->world;
    draw_box_outline(view, shown, box);
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
            window_->wait_events(0.1);  // minimized: nothing to draw on
            last = Clock::now();
            continue;
        }
        const Clock::time_point now = Clock::now();
        const double real = seconds_between(last, now);
        const float dt = static_cast<float>(std::min(real, kMaxFrameTime));
        last = now;

        if (window_->wants_to_close()) {  // by its button
            quits = inspector_.edit_count() == 0;
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
        if (inspector_.take_focus()) {
            focus_selection();
        }
        real_seconds_ += real;
        if (real_seconds_ >= 1.0) {
            rate_ = paused_ ? 1.0 : simulated_seconds_ / real_seconds_;
            real_seconds_ = simulated_seconds_ = 0.0;
        }
        if (events.left_clicked && !hud_->wants_mouse()) {
            select_under_pointer();
        }
        if (events.double_clicked && !hud_->wants_mouse()) {
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
        }
        simulate(dt, input);
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
