#include "tests/app/level_fixture.h"

#include "content/load/level/level_list.h"
#include "ecs/base/log.h"
#include "ecs/snapshot.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace limn::test {

HeadlessRenderer create_level_renderer(gpu::Profile profile) {
    // Anisotropic filters, which a software OpenGL never gets, draw other details than the goldens.
    Result<HeadlessRenderer> made = create_headless_renderer(profile, {.anisotropy = 1});
    if (!made) {
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
        std::exit(1);
    }
    return *std::move(made);
}

HeadlessRenderer& level_renderer() {
    static HeadlessRenderer shared = create_level_renderer(gpu::Profile::Software);
    REQUIRE(shared.context->make_current().ok());  // another may have been created since
    return shared;
}

std::unique_ptr<Stage> open_level(const std::string& level, const ShowChoice& show) {
    static MadeAssets made;
    Result<std::unique_ptr<Stage>> stage = open_stage(level, {.show = show, .made = &made});
    REQUIRE_MESSAGE(stage.ok(), (stage ? std::string() : stage.error().message));
    return *std::move(stage);
}

void step_times(Stage& stage, int steps) {
    for (int i = 0; i < steps; ++i) {
        step_stage(stage);
    }
}

const std::vector<PlayedLevel>& played_levels() {
    constexpr int kSteps = 60;
    static const std::vector<PlayedLevel> played = [] {
        std::vector<PlayedLevel> levels;
        for (const LevelEntry& level : list_levels()) {
            CAPTURE(level.name);
            const std::uint64_t errors_before = logged_error_count();
            PlayedLevel made = {.name = level.name, .stage = open_level(level.path)};
            step_times(*made.stage, kStepsToRepeat);
            made.hash = state_hash(made.stage->world);
            step_times(*made.stage, kSteps - kStepsToRepeat);
            made.logged_error = logged_error_count() != errors_before;
            levels.push_back(std::move(made));
        }
        return levels;
    }();
    return played;
}

}  // namespace limn::test
