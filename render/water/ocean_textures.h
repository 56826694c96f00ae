#pragma once

#include "ecs/components/ocean.h"
#include "render/gpu/texture.h"

#include <span>
#include <vector>

namespace limn {

// The patches of all seas as layers of texture arrays with repeat wrapping. Seas with fewer points
// per side are resampled to the largest size, which changes nothing: bilinear interpolation between
// coarse points is bilinear between finer ones.

/// Simulation data of one sea.
struct OceanSource {
    const OceanState* state = nullptr;
    const OceanFoam* foam = nullptr;  ///< null: none
    float now = 0;                    ///< time shown, relative to the state's time [s], <= 0
    float before = 0;                 ///< time of the previous frame, relative to the state [s]
};
/// Layers of one sea.
struct OceanLayers {
    int first_layer = 0;
    int patches = 0;          ///< 0: not in the textures
    Vec3 margin = {0, 0, 0};  ///< maximum displacement of the surface [m]
    Vec4 variance = Vec4(0);  ///< slope variance of each patch
};

class OceanTextures {
  public:
    /// Packs and uploads all seas; `with_previous` also the previous frame.
    void update(std::span<const OceanSource> seas, bool with_previous);

    [[nodiscard]] bool empty() const { return layer_count_ == 0; }
    [[nodiscard]] int size() const { return size_; }  ///< points per side
    [[nodiscard]] const std::vector<OceanLayers>& layers() const { return layers_; }
    /// RGBA32F with mip levels: shift_x, height, shift_z, 0.
    [[nodiscard]] const gpu::Texture& shift() const { return shift_; }
    [[nodiscard]] const gpu::Texture& previous_shift() const {
        return previous_shift_ ? previous_shift_ : shift_;
    }
    /// RGBA32F with mip levels: slope_x, slope_z, shift_xx, shift_zz.
    [[nodiscard]] const gpu::Texture& slope() const { return slope_; }
    /// RG32F with mip levels: shift_xz, foam.
    [[nodiscard]] const gpu::Texture& foam() const { return foam_; }

  private:
    int size_ = 0;
    int layer_count_ = 0;
    std::vector<OceanLayers> layers_;
    gpu::Texture shift_;
    gpu::Texture previous_shift_;
    gpu::Texture slope_;
    gpu::Texture foam_;
    std::vector<Vec4> texels_;
    std::vector<Vec2> pairs_;
};

}  // namespace limn
