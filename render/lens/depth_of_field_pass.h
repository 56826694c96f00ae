#pragma once

#include "render/effect.h"
#include "render/gpu/buffer.h"
#include "render/shaders/depth_of_field_gpu.h"

namespace limn {

// Depth of field: spreads out-of-focus light over its circle of confusion (thin_lens.h).
//
// Reads    radiance; LensDepth, or depth
// Writes   radiance through the lens
// Order    after everything drawn into the scene and after motion blur, before glow
// Shaders  depth_of_field_*; lib/depth_of_field.glsl, layout in depth_of_field_gpu.h
//
// Circles of up to 5 px are gathered at full resolution. Wider ones are gathered at half
// resolution, far and near field separately: up to a radius of 8 px, every neighboring texel is
// tested for whether its circle covers the current one, and weighted by the inverse of its area.
// Wider circles are gathered at quarter resolution with up to 48 taps, on mip levels coarse enough
// to leave no gaps. In-focus surfaces therefore never leak into blurred ones, and the near field
// spreads over what is behind it; what it hides there is inpainted from its surroundings. Behind
// the focus, clearly narrower circles are composited over the others, similar ones are averaged.
// Highlights with wide circles, which would reveal the tap pattern, are extracted and drawn as
// discs at full resolution. A disc is drawn only if it brightens its surroundings by some percent,
// which bounds the overdraw.
//
// Tiles of 16 px are classified: a tile in focus is only copied. Blended surfaces are as
// sharp as the surface behind them; so are particles, except where they cover most of a pixel.
// After Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare" (2014), and
// Abadie, "A Life of a Bokeh" (2018).
//
// FocusMethod::Mip is the cheapest method (post.dof-mip): sharp surfaces leak into blurred ones,
// near ones keep their outline, discs are squares.

struct DepthOfFieldPass {
    const gpu::Program* blocks = nullptr;
    const gpu::Program* spread = nullptr;
    const gpu::Program* tiles = nullptr;
    const gpu::Program* dilate = nullptr;
    const gpu::Program* pack = nullptr;
    const gpu::Program* split = nullptr;
    const gpu::Program* light = nullptr;
    const gpu::Program* base = nullptr;
    const gpu::Program* coarse = nullptr;
    const gpu::Program* gather = nullptr;
    const gpu::Program* compose[4] = {};  ///< [1]: with small circles, [2]: with large ones
    const gpu::Program* disc = nullptr;
    const gpu::Program* mip = nullptr;
    gpu::Buffer focus;  ///< layout::FocusBlock
};

[[nodiscard]] Result<DepthOfFieldPass> create_depth_of_field_pass(gpu::Device& device);

/// Whether the view's lens can produce a circle of visible size.
[[nodiscard]] bool has_depth_of_field(const RenderView& view);

/// The view's circles of confusion, and the kernels that spread discs of their size at full and at
/// half resolution.
[[nodiscard]] layout::FocusBlock make_focus_block(const RenderView& view);

/// The image through the view's lens; requires has_depth_of_field(view).
[[nodiscard]] TextureId draw_depth_of_field(
    FrameGraph& graph, DepthOfFieldPass& pass, const RenderView& view, TextureId radiance,
    TextureId depth);

struct DepthOfFieldEffect {
    DepthOfFieldPass pass;

    static Result<DepthOfFieldEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame) { return has_depth_of_field(frame.camera); }
    void draw(FrameGraph& graph, const FrameData&, ViewData& view);
};

}  // namespace limn
