// What `limn play` reads and writes while it runs: shaders, screenshots, EXR images.

#include "content/app/commands/image_file.h"
#include "content/app/commands/image_notes.h"
#include "content/app/commands/trial_file.h"
#include "content/app/panels/edit_save.h"
#include "content/app/player/player.h"
#include "content/game/wrinkle_trial_system.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/png_file.h"
#include "ecs/base/log.h"
#include "render/gpu/shader_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

// Techniques: wrinkle.compression.ab-evaluation

namespace limn {
namespace {

constexpr int kExrSamples = 16;

/// The window's pixels, rows from top to bottom, RGB.
std::vector<std::uint8_t> read_window(const IVec2& size) {
    const std::size_t row = static_cast<std::size_t>(size.x) * 3;
    std::vector<std::uint8_t> pixels(row * size.y);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (int y = 0; y < size.y / 2; ++y) {
        std::swap_ranges(
            pixels.begin() + static_cast<std::ptrdiff_t>(row) * y,
            pixels.begin() + static_cast<std::ptrdiff_t>(row) * (y + 1),
            pixels.end() - static_cast<std::ptrdiff_t>(row) * (y + 1));
    }
    return pixels;
}

}  // namespace

void Player::reload_shaders(bool all) {
    gpu::ShaderLibrary& shaders = device_->shaders();
    const gpu::ReloadReport report = all ? shaders.reload_all() : shaders.reload_changed();
    if (report.reloaded == 0 && report.errors.empty()) {
        return;
    }
    files_changed_ = files_changed_ || report.reloaded > 0;
    shader_error_ = report.errors.empty() ? "" : report.errors.front();
    for (const std::string& error : report.errors) {
        log_error("{}", error);
    }
    if (report.errors.empty()) {
        hud_->toast(fmt::format("{} shader programs reloaded", report.reloaded), ToastKind::Good);
    }
}

std::string Player::next_file(const char* ending) {
    const std::filesystem::path folder = options_.out.empty() ? "." : options_.out;
    std::error_code ignored;
    std::filesystem::create_directories(folder, ignored);
    std::filesystem::path path;
    do {
        path = folder / fmt::format("limn-{}-{:04}{}", stage_->scene.name, ++files_saved_, ending);
    } while (std::filesystem::exists(path, ignored));
    return path.lexically_normal().string();
}

void Player::save_screenshot(const IVec2& size) {
    const std::string path = next_file(".png");
    const Status status = write_png(path, size.x, size.y, 3, read_window(size));
    device_->invalidate_state();
    report_saved(path, status);
}

void Player::save_exr(const RenderView& view) {
    const std::string path = next_file(".exr");
    FrameRequest request;
    for (const std::string_view name : aov_names()) {
        request.aovs.emplace_back(name);
    }
    const FrameOutput frame =
        render_accumulated(*renderer_, stage_->world, view, kExrSamples, request);
    report_saved(path, write_image_file(path, frame, image_notes(*stage_, shown_time_)));
}

void Player::follow_trial() {
    const WrinkleTrialState* state = nullptr;
    std::as_const(stage_->world)
        .query<const WrinkleTrialState>()
        .each([&](const WrinkleTrialState& found) { state = &found; });
    if (state == nullptr) {
        trials_saved_ = 0;
        return;
    }
    // In each frame: a question stays until it is answered.
    if (state->stage == TrialStage::AnyDifference) {
        hud_->toast("Did the two differ?  N: no, Y: yes");
    } else if (state->stage == TrialStage::Preference) {
        hud_->toast("Which was better?  1: the first, 2: the second");
    }
    trials_saved_ = std::min(trials_saved_, state->records.size());
    if (trials_saved_ == state->records.size()) {
        return;
    }
    const std::filesystem::path folder = options_.out.empty() ? "." : options_.out;
    const std::string path =
        (folder / fmt::format("limn-{}-answers.csv", stage_->scene.name)).string();
    std::vector<TrialRecord> all;
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) {
        Result<std::vector<TrialRecord>> before = load_trials(path);
        if (!before) {
            trials_saved_ = state->records.size();
            report_saved(path, before.error());
            return;
        }
        all = *std::move(before);
    }
    all.insert(
        all.end(), state->records.begin() + static_cast<std::ptrdiff_t>(trials_saved_),
        state->records.end());
    trials_saved_ = state->records.size();
    std::filesystem::create_directories(folder, ignored);
    report_saved(path, write_file(path, write_trials(all)));
    fmt::print("{}", describe_tally(tally_trials(all)));
    std::fflush(stdout);
}

void Player::save_edits() {
    const UndoStack& edits = inspector_.undo_stack();
    if (edits.undo_count() == 0) {
        hud_->toast("no edits to save");
        return;
    }
    const std::string path =
        edited_path_.empty() ? new_edited_path(stage_->scene.path) : edited_path_;
    const Result<EditedLevel> level = edited_level(
        stage_->scene.path, path, stage_->world, edits.done(), stage_->scene.fields.entities);
    const Status status = level ? write_file(path, level->text) : Status(level.error());
    report_saved(path, status);
    if (!status) {
        return;
    }
    edited_path_ = path;
    if (level->left_out.empty()) {
        inspector_.note_saved();
    }
    for (const std::string& what : level->left_out) {
        log_warn("{}: saved without {}", path, what);
        hud_->toast("saved without " + what, ToastKind::Bad);
    }
}

void Player::report_saved(const std::string& path, const Status& status) {
    if (!status) {
        log_error("{}", status.error().message);
        hud_->toast(status.error().message, ToastKind::Bad);
        return;
    }
    fmt::print("{}\n", path);
    std::fflush(stdout);
    hud_->toast("saved " + path, ToastKind::Good);
}

}  // namespace limn
