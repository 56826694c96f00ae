#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"

#include <cstddef>
#include <span>

namespace limn {

// Several textures as cells of one image, so that what has them can be one batch (engine.texture-
// atlas). Cells are squares whose side is a power of two: each texel of a mip level is of one cell
// down to the level where a cell is one texel. Filters read neighboring texels, too: a gutter
// around each texture, of the color of its edge, keeps them within the cell down to the level in
// which half a texel is as wide as the gutter, the last that may be read. Without a gutter all
// levels may be read, and texture coordinates are half a texel inside, so that only filters of
// level 0 stay within the cell.

struct AtlasLayout {
    int columns = 1;
    int rows = 1;
    int cell = 1;    ///< side of a cell, a power of two [px]
    int gutter = 0;  ///< at each side of a texture, less than half a cell [px]
};

/// As near to a square as it can be, with cells of at least `largest` pixels, unless the image
/// would be larger than `max_size`. `gutter`: in pixels of a cell of 512.
[[nodiscard]] AtlasLayout
lay_out_atlas(std::size_t textures, int largest, int max_size, float gutter);

/// In which part of the image a texture is: uv' = offset + scale * uv, for uv in 0 .. 1.
struct AtlasCell {
    Vec2 offset = {0, 0};
    Vec2 scale = {1, 1};
};
[[nodiscard]] AtlasCell atlas_cell(const AtlasLayout& layout, std::size_t cell);

/// The last mip level that may be read.
[[nodiscard]] int last_atlas_level(const AtlasLayout& layout);

/// The image. Textures must be complete RGBA8 of equal encoding and no more than there are cells;
/// each is stretched over its cell without the gutter: smaller as the mean of what a texel covers,
/// larger by linear interpolation, of colors in linear light. Cells without a texture (null) are
/// white.
[[nodiscard]] ImageData
make_atlas(const AtlasLayout& layout, std::span<const ImageData* const> textures);

}  // namespace limn
