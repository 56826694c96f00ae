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
// under a tent of two texels, U is its transpose, bilinear interpolation; both smooth a little more
// (1 2 1), so that the levels' grids do not show and each level is nearly a Gaussian. D and U keep
// the sum of all light exactly, at odd sizes and at the border, too: there the picture is mirrored,
// so that what would leave it comes back. Weights that fall with the size of the level make the sum
// a power of the distance, as the halo of a real lens is.
//
// Reads    radiance
// Writes   radiance with glow
// Order    last before the picture is developed
// Shaders  glow_first.frag, glow_step.frag, glow_mix.frag; lib/pyramid.glsl
//
// In the first step, lone pixels far brighter than `firefly` count less (Karis, "Real Shading in
// Unreal Engine 4", 2013). What is held back is not lost: it stays in the pixel that it was in. NaN
// and infinite radiance glow not at all, nor do the pixels that touch them.
// After Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.

struct GlowPass {
    const gpu::Program* first = nullptr;
    const gpu::Program* first_any = nullptr;  ///< of a picture of odd size
    const gpu::Program* down = nullptr;
    const gpu::Program* up = nullptr;
    const gpu::Program* mix = nullptr;
    const gpu::Program* mix_any = nullptr;
};

[[nodiscard]] Result<GlowPass> create_glow_pass(gpu::Device& device);

/// The picture with its glow. `glow.strength` > 0.
[[nodiscard]] TextureId
draw_glow(FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance);

/// Weights of the levels, from the one of a quarter of the picture's size on; they sum to 1. The
/// last level comes in gradually as the radius grows.
[[nodiscard]] std::vector<float> glow_weights(const Glow& glow, int width, int height);

}  // namespace limn
