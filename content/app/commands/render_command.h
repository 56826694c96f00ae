#pragma once

#include "content/app/commands/command_values.h"
#include "content/app/commands/film_writer.h"
#include "content/app/commands/stage.h"
#include "content/load/level/level_show.h"
#include "content/load/model_view.h"
#include "render/gpu/device_caps.h"
#include "render/render_frame.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

// Shown by `limn render --show shadow.volume-count --aov volume_layers -o layers.exr`:
//     shadow.density-view
// Shown by `limn render gallery --renderer plain -o plain.png`: engine.profile-select
// Shown by `limn render stilllife --renderer plain -o plain.png`: engine.render-profile
// Shown by `limn render museum --profile gpu -o museum.png`: shade.profile
// Shown by `limn render museum -o museum.exr`: engine.draw-frame, hdr.float-formats, hdr.openexr
// Shown by `limn render stilllife --spp 64 -o stilllife.png`: post.distributed-sampling
// Shown by `limn render museum --set exposure.ev=-1 -o dark.png`: engine.param-access

/// `limn render`: renders images without a window.
struct RenderOptions {
    std::string scene;  ///< level name, level file or glTF; empty: the first level with the show
    std::string out;    ///< .png, .exr, with %04d in the name for a range; or a film of a range
    IVec2 size = {1280, 720};
    std::optional<double> time;        ///< of a single image [s]; default: the show's, or 0
    std::optional<FrameRange> frames;  ///< frame n shows time n / fps
    double fps = 60.0;
    std::optional<std::uint64_t> seed;    ///< overrides the level's
    int samples = 0;                      ///< per pixel; 0: real-time effects, antialiased
    int edge_samples = 16;                ///< antialiasing samples with real-time effects
    std::optional<SampleMean> average;    ///< empty: of the light for --spp and EXR, else displayed
    std::vector<std::string> aovs;        ///< additional EXR layers
    std::vector<Assignment> assignments;  ///< applied after loading, in order
    std::string camera;                   ///< by name; empty = the level's
    ShowChoice show;                      ///< what to show of the level
    std::optional<gpu::Profile> profile;  ///< empty = chosen by the device
    std::string renderer;                 ///< of render_profiles(); empty = the best
    ModelViewOptions model;               ///< of a single model
    FilmSettings film;                    ///< of a film; its rate is `fps`
    bool keep_frames = false;             ///< of a film, after it is made
    bool quiet = false;                   ///< prints nothing but errors and warnings
};

/// Rejects options that exclude each other and invalid output names; errors are wrong usage.
[[nodiscard]] Status check_render_options(const RenderOptions& options);

/// Writes every image under a temporary name and renames it, so an interrupted run leaves only
/// complete files. On a terminal shows progress; finally prints a line with the file, its size
/// and the time it took.
///
/// The frames of a film are images in the folder NAME.frames beside it. Those that a stopped run
/// left there are not rendered again; it fails where they are of other settings (render_record.h).
/// The folder is removed when the film is whole.
[[nodiscard]] Status run_render(const RenderOptions& options);

}  // namespace limn
