#pragma once

#include "content/app/command_values.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

/// `limn render`: pictures without a window.
struct RenderOptions {
    std::string scene;  ///< level name, level file or glTF
    std::string out;    ///< .png, .exr; with %04d in the name for a range
    IVec2 size = {1280, 720};
    double time = 0.0;                 ///< of a single picture [s]
    std::optional<FrameRange> frames;  ///< frame n shows time n / fps
    double fps = 60.0;
    std::optional<std::uint64_t> seed;  ///< instead of the level's
    int samples = 0;                ///< of pixel, lens and shutter; 0: as played, with smooth edges
    std::vector<std::string> aovs;  ///< further layers of an EXR
    std::vector<Assignment> assignments;  ///< applied after loading, in order
    std::string camera;                   ///< by name; empty = the level's
};

/// What options may not stand together, and names that no picture can be written under: wrong
/// usage.
[[nodiscard]] Status check_render_options(const RenderOptions& options);

/// Writes every picture under a temporary name and renames it, so a stopped run leaves whole files
/// only.
[[nodiscard]] Status run_render(const RenderOptions& options);

}  // namespace limn
