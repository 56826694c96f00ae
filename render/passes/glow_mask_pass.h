#pragma once

#include "ecs/components/glow.h"
#include "render/gbuffer.h"
#include "render/separable_blur.h"

namespace limn {

// Glow of what shines by itself (post.glow): the surfaces' emission, all else black, at half the
// size, blurred and added to the picture. What stands before a lamp hides it, for the emission is
// that of the surfaces seen. Adds light, unlike the glow of a lens, and is blind to what mirrors or
// passes it on; blended surfaces emit no glow.
//
// Reads    radiance, surface and depth of the G-buffer
// Writes   radiance with glow
// Shaders  glow_mask.frag, separable_blur.frag, glow_add.frag

struct GlowMaskPass {
    const gpu::Program* mask = nullptr;
    const gpu::Program* add = nullptr;
    SeparableBlur blur;
};

[[nodiscard]] Result<GlowMaskPass> create_glow_mask_pass(gpu::Device& device);

/// `glow.strength` > 0.
[[nodiscard]] TextureId draw_glow_mask(
    FrameGraph& graph, const GlowMaskPass& pass, const Glow& glow, const Gbuffer& gbuffer,
    TextureId radiance);

}  // namespace limn
