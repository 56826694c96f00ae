#pragma once

#include "ecs/components/projector.h"
#include "render/gpu/texture.h"
#include "render/light_list.h"
#include "render/shaders/projector_gpu.h"

#include <vector>

namespace limn {

struct Assets;

// Lights that throw images: one record each, and their images as layers of one texture, so that a
// loop over lights can meet any number of them. An image is resampled to a layer when it is first
// thrown; beyond kMaxProjectorImages the light throws none and is told of once.

inline constexpr int kMaxProjectorImages = 8;
inline constexpr int kProjectorImageSize = 512;  ///< side of a layer [texels]

/// The frame shown at `time` [s].
[[nodiscard]] int projector_frame(const Projector& projector, double time);

/// Of a light at `pose`; `layer` of the images.
[[nodiscard]] layout::ProjectorRecord make_projector_record(
    const Projector& projector, LightKind kind, const Affine& pose, double time, int layer);

class ProjectorPool {
  public:
    /// Fills records() and sets LightRecord::shadow.w of the lights that throw images. Other assets
    /// than last time are noticed.
    void update(const Assets& assets, LightList& lights);

    [[nodiscard]] const std::vector<layout::ProjectorRecord>& records() const { return records_; }
    [[nodiscard]] const gpu::Texture& images() const { return images_; }

  private:
    [[nodiscard]] int layer_of(const Assets& assets, ImageId image);

    std::vector<layout::ProjectorRecord> records_;
    std::vector<ImageId> layers_;
    gpu::Texture images_;
    std::uint64_t assets_ = 0;  // identity of those that were uploaded
    bool reported_ = false;
};

}  // namespace limn
