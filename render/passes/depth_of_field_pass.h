#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/device.h"
#include "render/graph/frame_graph.h"

namespace limn {

struct LensView;
struct RenderView;

namespace layout {
struct FocusBlock;
}

// Depth of field: what is out of focus is spread over its circle of confusion (thin_lens.h).
//
// Reads    radiance, depth
// Writes   radiance through the lens
// Order    after all that draws into the scene and after motion blur, before glow
// Shaders  focus_*; lib/focus.glsl, layout in focus_gpu.h
//
// Circles of up to 5 px are gathered from the picture itself. Wider ones are gathered at half its
// size by up to 48 taps that fill the aperture, far and near ones apart, and of both those of up to
// 8 px radius apart from the rest: a tap asks a place whether its circle comes as far as here, and
// takes its light by the area that it is spread over. What is sharp therefore never leaks into what
// is not, and a near thing spreads over what is behind it; what it hides there is guessed from
// around it. The wider the circles, the coarser the level that the taps read, so that they leave no
// gaps. Highlights, which would show the pattern of the taps, are taken off and drawn as discs of
// their own, at full size. A disc must add some percent to what is around it to be worth one, which
// bounds how many lie over each other.
//
// Tiles of 16 px know what is to be done in them: where all is sharp, a copy. Blended surfaces are
// as sharp as what is behind them. After Jimenez, "Next Generation Post Processing in Call of Duty:
// Advanced Warfare" (2014), and Abadie, "A Life of a Bokeh" (2018).
//
// FocusMethod::Mip is the cheapest kind (post.dof-mip): sharp things leak into blurred ones, near
// ones keep their outline, discs are squares.

struct DepthOfFieldPass {
    const gpu::Program* tiles = nullptr;
    const gpu::Program* reach = nullptr;
    const gpu::Program* split = nullptr;
    const gpu::Program* light = nullptr;
    const gpu::Program* rest = nullptr;
    const gpu::Program* gather = nullptr;
    const gpu::Program* compose[4] = {};  ///< [1]: with small circles, [2]: with large ones
    const gpu::Program* disc = nullptr;
    const gpu::Program* mip = nullptr;
    gpu::Buffer focus;  ///< layout::FocusBlock
};

[[nodiscard]] Result<DepthOfFieldPass> create_depth_of_field_pass(gpu::Device& device);

/// Whether the widest circle of the view's lens can be told from a point.
[[nodiscard]] bool has_depth_of_field(const RenderView& view);

/// The picture through the lens of the view, for which has_depth_of_field.
[[nodiscard]] TextureId draw_depth_of_field(
    FrameGraph& graph,
    DepthOfFieldPass& pass,
    const RenderView& view,
    TextureId radiance,
    TextureId depth);

/// What the shaders know of the lens.
[[nodiscard]] layout::FocusBlock make_focus_block(const RenderView& view);

}  // namespace limn
