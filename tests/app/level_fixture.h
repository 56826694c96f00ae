#pragma once

#include "content/app/commands/headless.h"
#include "content/app/commands/stage.h"
#include "content/load/made_assets.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace limn::test {

// What the tests of levels share: they run in one process (TOGETHER in CMakeLists.txt), so that
// each program is compiled and each asset made once for golden images, shows and warm-up.

/// With the formats and definitions of a software OpenGL.
[[nodiscard]] HeadlessRenderer& level_renderer();

/// Fails the test where the level, a name or file, cannot be loaded.
[[nodiscard]] std::unique_ptr<Stage>
open_level(const std::string& level, const ShowChoice& show = {});

/// A level after a second.
struct PlayedLevel {
    std::string name;
    std::unique_ptr<Stage> stage;
    std::uint64_t hash = 0;  ///< of the state after kStepsToRepeat
    bool logged_error = false;
};
inline constexpr int kStepsToRepeat = 10;

void step_times(Stage& stage, int steps);

/// All levels, in the order of list_levels().
[[nodiscard]] const std::vector<PlayedLevel>& played_levels();

/// A renderer of its own; ends the program where there is none.
[[nodiscard]] HeadlessRenderer create_level_renderer(gpu::Profile profile);

}  // namespace limn::test
