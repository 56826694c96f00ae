#pragma once

#include "ecs/components/glow.h"
#include "render/effect.h"
#include "render/lens/separable_blur.h"

#include <vector>

namespace limn {

// Glow (bloom): light scattered by a lens (post.glow).
//
//     out = (1 - s) I + s B(I),    B = sum of w_k U^k D^k,   sum of w_k = 1
//
// B is a pyramid of images, each half as large as the previous one. D downsamples with a tent
// filter two texels wide, U is its transpose, bilinear interpolation; both smooth a little more (1
// 2 1), so that the levels' grids do not show and each level is nearly a Gaussian. D and U conserve
// the total light exactly, also at odd sizes and at the border, where the image is mirrored so that
// no light leaves it. Weights that fall with the level make the sum a power of the
// distance, like the halo of a real lens.
//
// Reads    radiance
// Writes   radiance with glow
// Order    last before tone mapping
// Shaders  glow_first.frag, glow_step.frag, glow_mix.frag; lib/pyramid.glsl
//
// The first downsampling has a firefly clamp: isolated pixels far brighter than `firefly` are
// weighted down (Karis, "Real Shading in Unreal Engine 4", 2013). The light held back stays in its
// own pixel. NaN and infinite radiance does not glow, nor do the pixels that touch it. After
// Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.

struct GlowPass {
    const gpu::Program* first = nullptr;
    const gpu::Program* first_odd = nullptr;  ///< for images of odd size
    const gpu::Program* down = nullptr;
    const gpu::Program* up = nullptr;
    const gpu::Program* down_twice = nullptr;  ///< between sizes of exactly 2 : 1
    const gpu::Program* up_twice = nullptr;
    const gpu::Program* mix = nullptr;
    const gpu::Program* mix_odd = nullptr;
};

[[nodiscard]] Result<GlowPass> create_glow_pass(gpu::Device& device);

/// The image with its glow. `glow.strength` > 0.
[[nodiscard]] TextureId
draw_glow(FrameGraph& graph, const GlowPass& pass, const Glow& glow, TextureId radiance);

/// Weights of the levels, starting at quarter resolution; they sum to 1. The last level fades in as
/// the radius grows.
[[nodiscard]] std::vector<float> glow_weights(const Glow& glow, int width, int height);

// Glow of emissive surfaces (post.glow): their emission, all else black, at half resolution,
// blurred and added to the image. Occluded emitters do not glow, as only visible surfaces count.
// Adds light, unlike the glow of a lens, and ignores reflected and refracted emission; blended
// surfaces do not glow.
//
// Reads    radiance, surface and depth of the G-buffer
// Writes   radiance with glow
// Shaders  glow_mask.frag, separable_blur.frag, glow_add.frag

struct GlowMaskPass {
    const gpu::Program* mask = nullptr;
    const gpu::Program* add = nullptr;
    SeparableBlur blur;
};

/// Glow of the kind that the world requests. Glow of a lens is added to the mean of an accumulated
/// image, not to its samples; a mask to the samples, since it needs their surfaces.
struct GlowEffect {
    GlowPass lens;
    GlowMaskPass mask;

    static Result<GlowEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
