#pragma once

#include "content/app/command_values.h"
#include "render/gpu/device_caps.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

/// `limn render`: renders images without a window.
struct RenderOptions {
    std::string scene;  ///< level name, level file or glTF
    std::string out;    ///< .png, .exr; with %04d in the name for a range
    IVec2 size = {1280, 720};
    double time = 0.0;                 ///< of a single image [s]
    std::optional<FrameRange> frames;  ///< frame n shows time n / fps
    double fps = 60.0;
    std::optional<std::uint64_t> seed;    ///< overrides the level's
    int samples = 0;                      ///< per pixel; 0: effects as played, antialiased
    std::vector<std::string> aovs;        ///< additional EXR layers
    std::vector<Assignment> assignments;  ///< applied after loading, in order
    std::string camera;                   ///< by name; empty = the level's
    std::optional<gpu::Profile> profile;  ///< empty = by the device
};

/// Rejects options that exclude each other and invalid output names; errors are wrong usage.
[[nodiscard]] Status check_render_options(const RenderOptions& options);

/// Writes every image under a temporary name and renames it, so an interrupted run leaves only
/// complete files.
[[nodiscard]] Status run_render(const RenderOptions& options);

}  // namespace limn
