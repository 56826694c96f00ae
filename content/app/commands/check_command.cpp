#include "content/app/commands/check_command.h"

#include "content/app/commands/headless.h"
#include "content/app/commands/stage.h"
#include "content/load/level/particle_warnings.h"
#include "ecs/base/log.h"
#include "render/render_frame.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string_view>

namespace limn {
namespace {

constexpr int kSteps = 60;
constexpr IVec2 kSize = {320, 180};

std::atomic<int> warning_count{0};

/// Logs to stderr as usual, and counts.
void count_message(LogLevel level, std::string_view message) {
    if (level == LogLevel::Warn) {
        ++warning_count;
    }
    fmt::print(
        stderr, "{}: {}\n",
        level == LogLevel::Warn    ? "warning"
        : level == LogLevel::Error ? "error"
                                   : "note",
        message);
}

}  // namespace

Status run_check(const std::string& scene) {
    const std::uint64_t errors_before = logged_error_count();
    set_log_sink(count_message);
    set_log_level(LogLevel::Debug);
    StageOptions options;
    options.model.load.max_warnings = SIZE_MAX;
    const std::unique_ptr<Stage> stage = LIMN_TRY(open_stage(scene, options));
    static_cast<void>(stage_sounds(*stage));  // warns
    for (int i = 0; i < kSteps; ++i) {
        step_stage(*stage);
    }
    for (const SceneWarning& warning : find_dropped_births(stage->world)) {
        log_warn("{}", warning.text);
    }
    std::string drawn = "drew a frame";
    Result<HeadlessRenderer> headless = create_headless_renderer();
    if (headless) {
        warm_up_world(*headless, stage->world, stage->scene.camera, kSize);
        const RenderView view = make_render_view(
            stage->world, stage->scene.camera, {.width = kSize.x, .height = kSize.y});
        static_cast<void>(render_frame(*headless->renderer, stage->world, view));
    } else {
        drawn = "drew nothing: " + headless.error().message;
    }
    const std::uint64_t errors = logged_error_count() - errors_before;
    const int warnings = warning_count;
    if (errors > 0) {
        return fail("{}: {} errors and {} warnings", stage->scene.path, errors, warnings);
    }
    fmt::print(
        "{}: {} entities, simulated a second, {}; {}\n", stage->scene.path,
        stage->world.entity_count(), drawn,
        warnings == 0   ? std::string("no warnings")
        : warnings == 1 ? std::string("1 warning")
                        : fmt::format("{} warnings", warnings));
    return Done{};
}

}  // namespace limn
