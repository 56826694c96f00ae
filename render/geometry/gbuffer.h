#pragma once

#include "render/graph/frame_graph.h"

namespace limn {

/// The textures that hold a frame's surfaces (lib/gbuffer.glsl). Pixels without a surface keep
/// depth 0; their other attributes are undefined.
struct Gbuffer {
    TextureId surface;    ///< RGBA32UI
    TextureId material;   ///< R32UI: index of the material's record; only valid() where passes
                          ///< read it; RG32UI with `layers`
    TextureId layers;     ///< RGBA32UI: lib/surface_layers.glsl; only valid() where some material
                          ///< has layers
    TextureId key_light;  ///< RG8: visibility of the key lights (lib/key_lights.glsl); only valid()
                          ///< where some relief traces rays toward them
    TextureId depth;      ///< D32F, reversed: 1 at the near plane, 0 for background; plus 8 bits of
                          ///< stencil, all 0, if needs_stencil()
    TextureId velocity;   ///< RG16F or RG32F: current uv - previous uv, also for the sky; not
                          ///< valid() unless requested
};

}  // namespace limn
