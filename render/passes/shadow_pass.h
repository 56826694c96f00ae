#pragma once

#include "render/frame_scene.h"

namespace limn {

// Draws the shadow maps that are due into the one atlas; all others keep their depths.
//
// Reads    ShadowList
// Writes   shadow atlas: reversed depth of the caster nearest to the light, 0 where there is none
// Order    before whatever is lit
// Shaders  mesh.vert, shadow_map.frag
//
// Casters are drawn from both sides: a wall shades whichever way it faces. There is no bias in the
// maps, what is lit looks for it (lib/shadow.glsl).

struct ShadowPass {
    SurfacePrograms programs;
    gpu::Texture atlas;  ///< one texel until there is a shadow
};

[[nodiscard]] Result<ShadowPass> create_shadow_pass(gpu::Device& device);

/// Makes the atlas as large as the list wants it: empty, if it was smaller.
void resize_shadow_atlas(ShadowPass& pass, const ShadowList& list);

/// The atlas with this frame's maps; not valid if nothing casts shadows.
[[nodiscard]] TextureId draw_shadows(FrameGraph& graph, ShadowPass& pass, const FrameScene& scene);

}  // namespace limn
