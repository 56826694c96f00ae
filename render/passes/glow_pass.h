#pragma once

#include "ecs/components/glow.h"
#include "render/gpu/program.h"
#include "render/graph/frame_graph.h"

#include <vector>

namespace limn {

// Glow: what a lens scatters (post.glow).
//
//     out = (1 - s) I + s B(I),    B = sum of w_k U^k D^k,   sum of w_k = 1
//
// B is a pyramid of pictures, each half as large as the one before. D makes a texel from what lies
// under a tent of two texels, U is its transpose, bilinear interpolation: repeated, they are nearly
// Gaussian (quadratic B-splines) and keep every light's middle where it was. Both keep the sum of
// all light exactly, at odd sizes and at the border, too: there the picture is mirrored, so that
// what would leave it comes back. Weights w_k that fall with the size of the level make the sum of
// near-Gaussians a power of the distance, as the halo of a real lens is.
//
// Reads    radiance
// Writes   radiance with glow
// Order    last before the picture is developed
// Shaders  glow_down.frag, glow_up.frag, glow_mix.frag; lib/pyramid.glsl
//
// In the first step, lone pixels far brighter than `firefly` count less (Karis, "Real Shading in
// Unreal Engine 4", 2013). What is held back is not lost: it stays in the pixel that it was in. NaN
// and infinite radiance glow not at all, nor do the pixels that touch them.
// After Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.

struct GlowPass {
    const gpu::Program* first[2] = {};  ///< [1]: of any size, not just even ones
    const gpu::Program* down[2] = {};
    const gpu::Program* up[2] = {};
    const gpu::Program* mix[2] = {};
};

[[nodiscard]] Result<GlowPass> create_glow_pass(gpu::Device& device);

/// The picture with its glow. `glow.strength` > 0.
[[nodiscard]] TextureId
draw_glow(FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance);

/// Weights of the levels, from the one of half the picture's size on; they sum to 1. The last level
/// comes in gradually as the radius grows.
[[nodiscard]] std::vector<float> glow_weights(const Glow& glow, int width, int height);

}  // namespace limn
