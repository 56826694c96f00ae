#pragma once

#include "ecs/components/post.h"
#include "render/passes/local_luminance_pass.h"
#include "render/passes/statistics_pass.h"
#include "render/passes/tone_map_pass.h"

#include <cstdint>
#include <optional>

namespace limn {

// Developing a picture, as in photography: from radiance to display by whatever an Exposure asks
// for (hdr.pipeline). The renderer ends with it and `limn view` is little else.

struct Developer {
    StatisticsPass statistics;
    LocalLuminancePass local;
    ToneMapPass tone_map;
    bool adapting = false;  ///< the eye's state is that of the picture before
};

[[nodiscard]] Result<Developer> create_developer(gpu::Device& device);

/// Adds the passes to this frame; returns the display, RGBA8. `seconds` since the picture before
/// let the eye of Metering::Auto follow; nothing means a cut, after which it is at home at once.
[[nodiscard]] TextureId develop(
    FrameGraph& graph, Developer& developer, const Exposure& exposure, std::optional<float> seconds,
    TextureId radiance);

/// Tells a cut from pictures that follow one another.
struct PictureClock {
    bool running = false;
    std::uint64_t world = 0;  ///< of the last picture
    double time = 0.0;        ///< [s]
    Affine camera;
};

/// Simulated seconds since the picture before. Nothing after a cut: another world, time that ran
/// back or on by more than a second, or a camera that jumped (is_cut).
[[nodiscard]] std::optional<float>
seconds_since_last(PictureClock& clock, std::uint64_t world, double time, const Affine& camera);

}  // namespace limn
