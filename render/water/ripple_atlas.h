#pragma once

#include "ecs/components/water_ripples.h"
#include "render/gpu/texture.h"

#include <span>
#include <vector>

namespace limn {

// The ripples of all bodies of water in one texture: each has a rectangle of it, a texel a cell,
// with one texel more around that repeats the outermost. A texel is height [m], velocity up [m/s]
// and the slopes by x and z.

/// Where the cells of one body are.
struct AtlasPlace {
    IVec2 corner = {0, 0};  ///< of the first cell [texels]
    bool fits = false;      ///< otherwise it is not in the texture
};

class RippleAtlas {
  public:
    /// Places all and uploads their texels. `max_side`: of a texture [px].
    void update(std::span<const RippleState* const> states, int max_side);

    [[nodiscard]] const std::vector<AtlasPlace>& places() const { return places_; }
    /// Not there before the first update; of no meaning where no body ripples.
    [[nodiscard]] const gpu::Texture& texture() const { return texture_; }

  private:
    std::vector<AtlasPlace> places_;
    std::vector<Vec4> texels_;
    gpu::Texture texture_;
};

/// Rectangles of these sizes next to and above each other, the tallest first, in a sheet `width`
/// wide; writes their corners and returns the height of the sheet.
[[nodiscard]] int
place_on_shelves(std::span<const IVec2> sizes, int width, std::span<IVec2> corners);

}  // namespace limn
