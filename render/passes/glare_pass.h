#pragma once

#include "ecs/components/glare.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Glare: the star that an aperture of straight blades makes of a point of light
// (post.glare-heat-haze).
//
//     out = I + strength * star(I (1 - threshold / luminance))
//
// Each edge diffracts light to both sides, perpendicular to itself; along such a line it falls with
// the square of the distance, and longer waves go farther. A line is a sum of tents, each twice as
// long as the one before, made by readings twice as far apart in each pass; the light of a star is
// that of its source, but for what leaves the picture. Bands of single colors, which daylight blurs
// away, are left out.
//
// Reads    radiance
// Writes   radiance with glare
// Order    before glow
// Shaders  glare_source.frag, glare_streak.frag, glare_add.frag

struct GlarePass {
    const gpu::Program* source = nullptr;
    const gpu::Program* streak = nullptr;
    const gpu::Program* add = nullptr;
    gpu::Sampler dark_outside;
};

[[nodiscard]] Result<GlarePass> create_glare_pass(gpu::Device& device);

/// `glare.strength` > 0.
[[nodiscard]] TextureId
draw_glare(FrameGraph& graph, const GlarePass& pass, const Glare& glare, TextureId radiance);

/// Lines through a point; each is two streaks.
[[nodiscard]] int glare_lines(const Glare& glare);

}  // namespace limn
