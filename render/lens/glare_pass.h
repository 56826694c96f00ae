#pragma once

#include "ecs/components/glare.h"
#include "render/effect.h"
#include "render/gpu/texture.h"

namespace limn {

// Glare: the star pattern that an aperture of straight blades makes of a point light
// (post.glare-heat-haze).
//
//     out = I + strength * star(I (1 - threshold / luminance))
//
// Each edge diffracts light to both sides, perpendicular to itself; along such a streak intensity
// falls off with the square of the distance, and longer wavelengths spread farther. A streak is a
// sum of tent filters, each twice as long as the previous one, from reads twice as far apart in
// each pass; a star conserves the light of its source, except for what leaves the image. Spectral
// bands, which blur away in daylight, are left out.
//
// Reads    radiance
// Writes   radiance with glare
// Order    before glow
// Shaders  glare_source.frag, glare_streak.frag, glare_add.frag

struct GlarePass {
    const gpu::Program* source = nullptr;
    const gpu::Program* streak = nullptr;
    const gpu::Program* add = nullptr;
    gpu::Sampler black_border;
};

[[nodiscard]] Result<GlarePass> create_glare_pass(gpu::Device& device);

/// `glare.strength` > 0.
[[nodiscard]] TextureId
draw_glare(FrameGraph& graph, const GlarePass& pass, const Glare& glare, TextureId radiance);

/// Number of lines through a point; each is two streaks.
[[nodiscard]] int glare_lines(const Glare& glare);

struct GlareEffect {
    GlarePass pass;

    static Result<GlareEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
