#pragma once

#include "ecs/components/projector.h"
#include "render/gpu/texture.h"
#include "render/light/light_list.h"
#include "render/shaders/projector_gpu.h"

#include <vector>

namespace limn {

struct Assets;

// Projected textures (cookies): one record per light with a Projector, and the images as layers of
// one texture array, so that a loop over lights handles any number of them. An image is resampled
// into a layer on first use; beyond kMaxProjectorImages a light has no cookie, which is reported
// once.

inline constexpr int kMaxProjectorImages = 8;
inline constexpr int kProjectorImageSize = 512;  ///< side of a layer [texels]

/// The animation frame at `time` [s].
[[nodiscard]] int projector_frame(const Projector& projector, double time);

/// Record of a light at `pose` whose cookie is `layer` of images().
[[nodiscard]] layout::ProjectorRecord make_projector_record(
    const Projector& projector, LightKind kind, const Affine& pose, double time, int layer);

class ProjectorPool {
  public:
    /// Fills records() and sets LightRecord::shadow.w of the lights with a cookie. Detects that
    /// `assets` have been replaced.
    void update(const Assets& assets, LightList& lights);

    [[nodiscard]] const std::vector<layout::ProjectorRecord>& records() const { return records_; }
    [[nodiscard]] const gpu::Texture& images() const { return images_; }

  private:
    [[nodiscard]] int layer_of(const Assets& assets, ImageId image);

    std::vector<layout::ProjectorRecord> records_;
    std::vector<ImageId> layers_;
    gpu::Texture images_;
    std::uint64_t assets_ = 0;  // identity of the uploaded assets
    bool reported_ = false;
};

}  // namespace limn
