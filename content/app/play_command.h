#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <string>

namespace limn {

/// `limn play`: a level in a window or, where there is no display, as pictures along its camera
/// path.
struct PlayOptions {
    std::string scene;  ///< empty: the tour
    IVec2 size = {1280, 720};
    bool fullscreen = false;
    float scale = 0.0f;       ///< rendered pixels a window pixel; 0 = by the machine
    bool scale_auto = false;  ///< changes the scale to hold 60 frames a second
    int headless_frames = 0;  ///< > 0: so many pictures along the camera path, and no window
    std::string out;  ///< folder of pictures and screenshots; empty = limn-<level> for pictures,
                      ///< the current one for screenshots
};

[[nodiscard]] Status run_play(const PlayOptions& options);

}  // namespace limn
