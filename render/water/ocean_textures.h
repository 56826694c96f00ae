#pragma once

#include "ecs/components/ocean.h"
#include "render/gpu/texture.h"

#include <span>
#include <vector>

namespace limn {

// The patches of all seas as layers of texture arrays, repeated at their edges. Seas of fewer
// points a side than another are brought to as many, which changes nothing: what is bilinear
// between coarse points is bilinear between finer ones.

/// One sea, and where it is among the layers.
struct OceanSource {
    const OceanState* state = nullptr;
    const OceanFoam* foam = nullptr;  ///< null: none
    float now = 0;                    ///< from the state's time to the moment shown [s], <= 0
    float before = 0;                 ///< to the moment before [s]
};
struct OceanPlace {
    int first_layer = 0;
    int patches = 0;          ///< 0: not in the textures
    Vec3 reach = {0, 0, 0};   ///< by which it moves the surface, at most [m]
    Vec4 variance = Vec4(0);  ///< of the slopes of each patch
};

class OceanTextures {
  public:
    /// Packs and uploads all. `with_before`: also the moment before.
    void update(std::span<const OceanSource> seas, bool with_before);

    [[nodiscard]] bool empty() const { return layers_ == 0; }
    [[nodiscard]] int size() const { return size_; }  ///< points along a side
    [[nodiscard]] const std::vector<OceanPlace>& places() const { return places_; }
    /// RGBA32F with levels: shift_x, height, shift_z, 0.
    [[nodiscard]] const gpu::Texture& shift() const { return shift_; }
    [[nodiscard]] const gpu::Texture& shift_before() const {
        return shift_before_ ? shift_before_ : shift_;
    }
    /// RGBA32F with levels: slope_x, slope_z, shift_xx, shift_zz.
    [[nodiscard]] const gpu::Texture& slope() const { return slope_; }
    /// RG32F with levels: shift_xz, foam.
    [[nodiscard]] const gpu::Texture& foam() const { return foam_; }

  private:
    int size_ = 0;
    int layers_ = 0;
    std::vector<OceanPlace> places_;
    gpu::Texture shift_;
    gpu::Texture shift_before_;
    gpu::Texture slope_;
    gpu::Texture foam_;
    std::vector<Vec4> texels_;
    std::vector<Vec2> pairs_;
};

}  // namespace limn
