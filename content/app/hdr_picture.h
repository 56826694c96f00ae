#pragma once

#include "ecs/base/result.h"
#include "render/develop.h"
#include "render/gpu/texture.h"
#include "render/graph/frame_graph.h"

#include <cstdint>
#include <memory>
#include <string>

namespace limn {

namespace gpu {
class Device;
}

// A picture of linear light, from a file, and how an Exposure shows it (hdr.viewer). Measured once,
// developed when something changes. It is on the GPU as it is in the file: NaN and infinity are
// left out of the statistics and shown as black and white.

/// hdr.log-average, hdr.defog and hdr.dynamic-range of the whole picture.
struct HdrStatistics {
    std::uint32_t pixels = 0;      ///< that count
    std::uint32_t not_finite = 0;  ///< pixels with NaN or infinity in them
    double log_average = 0.0;      ///< luminance
    Vec3 mean = {0, 0, 0};         ///< color
    double least = 0.0;            ///< luminance that is not 0
    double largest = 0.0;          ///< luminance
    double clipped_least = 0.0;    ///< without the darkest 0.1 %
    double clipped_largest = 0.0;  ///< without the brightest 0.1 %
};

class HdrPicture {
  public:
    /// OpenEXR or Radiance HDR. Fails with "path: found X, expected Y"; a picture of 8-bit codes is
    /// no light.
    [[nodiscard]] static Result<std::unique_ptr<HdrPicture>>
    load(gpu::Device& device, const std::string& path);

    /// The display's RGBA8 codes; good until the next call.
    const gpu::Texture& show(const Exposure& exposure);

    [[nodiscard]] const HdrStatistics& statistics() const { return statistics_; }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] int width() const { return radiance_.width(); }
    [[nodiscard]] int height() const { return radiance_.height(); }

  private:
    HdrPicture(gpu::Device& device, Developer developer, gpu::Texture radiance, std::string path);
    void measure();

    FrameGraph graph_;
    Developer developer_;
    gpu::Texture radiance_;
    std::string path_;
    HdrStatistics statistics_;
};

/// Largest over least luminance; 1 without any light.
[[nodiscard]] double range_ratio(double least, double largest);

/// Share of the pixels that have a channel at the display's end, 0 .. 1. Waits for the GPU.
[[nodiscard]] double clipped_share(const gpu::Texture& display);

/// The statistics in words, a few lines.
[[nodiscard]] std::string describe(const HdrPicture& picture);

}  // namespace limn
