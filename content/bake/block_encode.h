#pragma once

#include "ecs/base/block_texture.h"
#include "ecs/base/math.h"

#include <array>

namespace limn {

// Encodes blocks of 4 x 4 texels: BC5 (two channels) and BC7 (four), block_texture.h.
//
// BC7 takes the best of three of its modes: 6 (one line through the colors, 16 steps), 5 (a channel
// of its own, on lines of 4 steps) and 1 (opaque: two lines of 8 steps; the partitions whose
// subsets have the least variance off their lines are tried). Endpoints begin at the ends of the
// principal axis and are fitted to the indices by least squares. BC5 searches the endpoints of each
// channel around its range.
//
// No package of Debian 12 encodes BC7 (libsquish and NVTT 2.0 end with BC5). After Simon Brown,
// "DXT Compression Techniques", 2006, and Krajcevski, Lake and Manocha, "FasTC: Accelerated
// Fixed-Rate Texture Encoding", 2013.

/// Channels of 16 texels, 0 .. 255, not necessarily whole.
using BlockColors = std::array<Vec4, 16>;

/// Texels with alpha 255 in all 16 keep it exactly.
[[nodiscard]] BlockBytes encode_bc7(const BlockColors& texels);

/// Red and green of `texels`.
[[nodiscard]] BlockBytes encode_bc5(const BlockColors& texels);

}  // namespace limn
