#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

/// The textures that hold a frame's surfaces (lib/gbuffer.glsl). Pixels without a surface keep
/// depth 0; their attributes are undefined.
struct Gbuffer {
    TextureId surface;  ///< RGBA32UI
    TextureId depth;    ///< D32F, reversed: 1 at the near plane, 0 where nothing is; with 8 bits of
                        ///< stencil, all 0, where needs_stencil()
    TextureId velocity;  ///< RG16F or RG32F, uv now - uv before, of the sky, too; not valid()
                         ///< unless asked for
};

}  // namespace limn
