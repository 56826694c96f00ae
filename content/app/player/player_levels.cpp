// How the window of `limn play` opens a level, follows its files and leaves it.

#include "content/app/player/player.h"
#include "content/load/level/level_list.h"
#include "ecs/base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>

namespace limn {

Status Player::load(const std::string& scene, const std::string& show) {
    (void)sound_.update(0, false);
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
    inspector_.reset(
        {stage_->scene.model ? "" : stage_->scene.path, stage_->scene.fields.entities});
    edited_path_.clear();
    furrows_.reset();
    skeleton_.reset();
    markers_.close();
    camera_ = {};
    detail_costs_.forget();
    const Bounds& bounds = stage_->scene.bounds;
    if (stage_->scene.model && !is_empty(stage_->scene.model->subject)) {
        const float radius = glm::length(half_extent(stage_->scene.model->subject));
        camera_.unit = radius > 0 ? radius : 1;
    }
    if (!is_empty(bounds)) {
        camera_.view_distance = std::clamp(
            0.3f * glm::length(half_extent(bounds)), 0.5f * camera_.unit, 50.0f * camera_.unit);
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
    follow_sounds();
    warm_up_level();
    if (const ActionGroup* const driver = driving_group(stage_->world, stage_->scene.camera)) {
        hud_->toast(
            describe_group(*driver, std::as_const(stage_->world).find_resource<Bindings>()));
    }
    return Done{};
}

/// Takes over the scene's sounds where they are others than before.
void Player::follow_sounds() {
    std::vector<SoundPlayer> players;
    stage_->world.query<const SoundPlayer>().each(
        [&](const SoundPlayer& player) { players.push_back(player); });
    if (players != sound_players_ || sound_scene_ != stage_->scene.path) {
        sound_players_ = std::move(players);
        sound_scene_ = stage_->scene.path;
        sound_.set_sounds(stage_sounds(*stage_));
    }
}

/// Compiles the level's shaders, so that no frame has to.
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
    const char* const question =
        markers_.has_unsaved() ? "Quit Limn? Places of markers are not saved." : "Quit Limn?";
    leave_.ask(question, "Quit", [this] { window_->request_close(); });
}

std::vector<std::filesystem::file_time_type> Player::level_file_times() const {
    std::vector<std::filesystem::file_time_type> times;
    for (const std::string& file : stage_->scene.fields.files) {
        std::error_code missing;
        times.push_back(std::filesystem::last_write_time(file, missing));
    }
    return times;
}

void Player::follow_level_files() {
    std::vector<std::filesystem::file_time_type> times = level_file_times();
    if (times == level_times_) {
        return;
    }
    level_times_ = std::move(times);
    level_error_.clear();
    std::size_t updated = 0;
    const std::size_t edits = inspector_.edit_count();
    for (Stage* const stage : {stage_.get(), off_stage_.get()}) {
        if (stage == nullptr) {
            continue;
        }
        const Result<std::vector<LevelChange>> changes = update_level(
            stage->world, stage->scene.fields,
            {.technique = options_.show, .off = stage == off_stage_.get()}, &made_);
        if (!changes) {
            level_error_ = changes.error().message;
            level_error_ = level_error_.substr(0, level_error_.find('\n'));
            log_error("{}", level_error_);
            return;
        }
        updated += changes->size();
        if (stage == stage_.get()) {
            inspector_.undo_stack().adopt(*changes);
        }
    }
    level_times_ = level_file_times();  // it may include others now
    files_changed_ = files_changed_ || updated > 0;
    const std::size_t saved = edits - inspector_.edit_count();
    std::string message =
        updated == 0 ? "the file was saved without changes"
                     : fmt::format("level updated: {} change{}", updated, updated == 1 ? "" : "s");
    if (saved > 0) {
        message += fmt::format("; {} edit{} in the file now", saved, saved == 1 ? " is" : "s are");
    }
    hud_->toast(message, ToastKind::Good);
}

}  // namespace limn
