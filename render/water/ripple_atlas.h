#pragma once

#include "ecs/components/water_ripples.h"
#include "render/gpu/texture.h"

#include <span>
#include <vector>

namespace limn {

// The ripples of all bodies of water in one texture: a rectangle per body, one texel per cell, with
// a border texel that repeats the edge. A texel holds height [m], upward velocity [m/s] and the
// slopes along x and z.

/// The cells of one body in the atlas.
struct RippleTile {
    IVec2 corner = {0, 0};  ///< of the first cell [texels]
    bool fits = false;      ///< false: not in the texture
};

class RippleAtlas {
  public:
    /// Packs all bodies and uploads their texels. `max_side`: maximum texture size [px].
    void update(std::span<const RippleState* const> states, int max_side);

    [[nodiscard]] const std::vector<RippleTile>& tiles() const { return tiles_; }
    /// Null before the first update; meaningless if no body has ripples.
    [[nodiscard]] const gpu::Texture& texture() const { return texture_; }

  private:
    std::vector<RippleTile> tiles_;
    std::vector<Vec4> texels_;
    gpu::Texture texture_;
};

/// Shelf packing of rectangles, tallest first, into a sheet `width` wide; writes their corners and
/// returns the height of the sheet.
[[nodiscard]] int pack_shelves(std::span<const IVec2> sizes, int width, std::span<IVec2> corners);

}  // namespace limn
