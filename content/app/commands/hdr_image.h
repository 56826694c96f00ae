#pragma once

#include "ecs/base/result.h"
#include "render/gpu/texture.h"
#include "render/graph/frame_graph.h"
#include "render/lens/tone_mapper.h"

#include <cstdint>
#include <memory>
#include <string>

namespace limn {

namespace gpu {
class Device;
}

// An HDR image loaded from a file, and its tone mapping by an Exposure (hdr.viewer). Measured once,
// tone mapped when something changes. The GPU holds the file's values unchanged: NaN and infinity
// are excluded from the statistics and shown as black and white.

/// hdr.log-average, hdr.defog and hdr.dynamic-range of the whole image.
struct HdrStatistics {
    std::uint32_t pixels = 0;            ///< without NaN or infinity
    std::uint32_t not_finite = 0;        ///< pixels with NaN or infinity in them
    double log_average = 0.0;            ///< luminance
    Vec3 mean = {0, 0, 0};               ///< color
    double least = 0.0;                  ///< smallest luminance > 0
    double largest = 0.0;                ///< largest luminance
    double clipped_min_luminance = 0.0;  ///< `least` without the darkest 0.1 %
    double clipped_max_luminance = 0.0;  ///< `largest` without the brightest 0.1 %
};

class HdrImage {
  public:
    /// Any image that load_image reads; those of 8 bits become linear. Fails with "path: found X,
    /// expected Y".
    [[nodiscard]] static Result<std::unique_ptr<HdrImage>>
    load(gpu::Device& device, const std::string& path);

    /// Tone maps to RGBA8 display codes; valid until the next call.
    const gpu::Texture& show(const Exposure& exposure);

    [[nodiscard]] const HdrStatistics& statistics() const { return statistics_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] int width() const { return radiance_.width(); }
    [[nodiscard]] int height() const { return radiance_.height(); }

  private:
    HdrImage(gpu::Device& device, ToneMapper tone_mapper, gpu::Texture radiance, std::string path);
    void measure();

    FrameGraph graph_;
    ToneMapper tone_mapper_;
    gpu::Texture radiance_;
    std::string path_;
    HdrStatistics statistics_;
};

/// Largest over smallest luminance; 1 for a black image.
[[nodiscard]] double range_ratio(double least, double largest);

/// Fraction of the pixels with a channel at the display's maximum, 0 .. 1. Waits for the GPU.
[[nodiscard]] double clipped_fraction(const gpu::Texture& display);

/// The statistics as a few lines of text.
[[nodiscard]] std::string describe(const HdrImage& image);

}  // namespace limn
