#pragma once

#include "content/bake/bake_rows.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// Images in blocks (BC5, BC7) with mip levels of their own, since the GPU makes none of blocks.
// A texel of a level is the mean of the texels of the image that it covers: of colors in linear
// light, of normals as unit vectors, made unit vectors again (engine.opt-texture).

/// What the texels of an image are.
enum class TexelKind : std::uint8_t {
    Color,   ///< sRGB and alpha
    Normal,  ///< of tangent space
    Data,    ///< anything linear
};

struct BlockOptions {
    PixelFormat format = PixelFormat::Bc7;  ///< or Bc5
    TexelKind kind = TexelKind::Color;
    bool levels = true;  ///< down to 1 x 1; else the image alone
};

/// Rows of blocks in all levels, the total of the progress below.
[[nodiscard]] int block_rows(int width, int height, bool levels);

/// `image` must be complete and RGBA8. BC5 of normals stores x and y of unit vectors with z >= 0;
/// of others red and green. On all threads; the same bits for any number of them.
[[nodiscard]] ImageData encode_blocks(
    const ImageData& image, const BlockOptions& options, const RowProgress& progress = {});

}  // namespace limn
