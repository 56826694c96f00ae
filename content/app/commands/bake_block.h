#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

// Shown by `limn bake block wall.png -o wall.dds`: engine.opt-texture

/// An image of 8 bits as a DDS file in BC7 or BC5, with mip levels; prints how near it is.
Status bake_block(const BakeOptions& options);

}  // namespace limn
