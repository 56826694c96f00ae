#pragma once

#include "content/load/model_view.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/rendering.h"
#include "render/gpu/device_caps.h"

#include <optional>
#include <string>

namespace limn {

// Shown by `limn play museum --headless-frames 3`: engine.main-loop

class World;

/// `limn play`: plays a level in a window or, without a display, renders frames along its camera
/// path.
struct PlayOptions {
    std::string scene;  ///< empty: the first level with the show, or gallery
    std::string show;   ///< technique, an id of TECHNIQUES.md; empty: none
    IVec2 size = {1280, 720};
    bool fullscreen = false;
    float scale = 0.0f;       ///< rendered pixels per window pixel; 0 = automatic
    bool scale_auto = false;  ///< adapts the scale to hold 60 frames per second
    Antialiasing antialiasing = Antialiasing::Auto;  ///< Auto: the level's, temporal if it has none
    std::optional<gpu::Profile> profile;             ///< empty = chosen by the device
    std::string renderer;                            ///< of render_profiles(); empty = the best
    ModelViewOptions model;                          ///< of a single model
    std::string markers;                             ///< TRC file: its markers are placed on a face
    std::string map;                                 ///< file of their places; empty: beside it
    int headless_frames = 0;  ///< > 0: renders this many frames along the camera path, no window
    std::string out;  ///< folder of frames and screenshots; empty = limn-<level> for frames, the
                      ///< current one for screenshots
};

/// Antialiasing of played frames: `wanted`, else the level's, else temporal.
void set_antialiasing(World& world, Antialiasing wanted);

[[nodiscard]] Status run_play(const PlayOptions& options);

}  // namespace limn
