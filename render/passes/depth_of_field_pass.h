#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/device.h"
#include "render/graph/frame_graph.h"

namespace limn {

struct RenderView;

// Depth of field: what is out of focus is spread over its circle of confusion (thin_lens.h).
//
// Reads    radiance, depth
// Writes   radiance through the lens
// Order    after all that draws into the scene and after motion blur, before glow
// Shaders  focus_*; lib/focus.glsl, layout in focus_gpu.h
//
// Circles of up to 5 px are gathered from the picture itself. Wider ones are gathered at half its
// size, far and near ones apart: up to 8 px of radius every texel around is asked whether its
// circle comes as far as here, and its light is taken by the area that it is spread over. Of those
// that are wider still, up to 48 taps ask that at a quarter of the size, on levels as coarse as
// they need to leave no gaps. What is sharp therefore never leaks into what is not, and a near
// thing spreads over what is behind it; what it hides there is guessed from around it. Behind the
// focus, what has clearly narrower circles lies over the rest, what has about the same beside it.
// Highlights of wide circles, which would show the pattern of the taps, are taken off and drawn as
// discs of their own, at full size. A disc must add some percent to what is around it to be worth
// one, which bounds how many lie over each other.
//
// Tiles of 16 px know what is to be done in them: where all is sharp, a copy. Blended surfaces are
// as sharp as what is behind them. After Jimenez, "Next Generation Post Processing in Call of Duty:
// Advanced Warfare" (2014), and Abadie, "A Life of a Bokeh" (2018).
//
// FocusMethod::Mip is the cheapest kind (post.dof-mip): sharp things leak into blurred ones, near
// ones keep their outline, discs are squares.

struct DepthOfFieldPass {
    const gpu::Program* blocks = nullptr;
    const gpu::Program* spread = nullptr;
    const gpu::Program* tiles = nullptr;
    const gpu::Program* reach = nullptr;
    const gpu::Program* pack = nullptr;
    const gpu::Program* split = nullptr;
    const gpu::Program* light = nullptr;
    const gpu::Program* rest = nullptr;
    const gpu::Program* coarse = nullptr;
    const gpu::Program* gather = nullptr;
    const gpu::Program* compose[4] = {};  ///< [1]: with small circles, [2]: with large ones
    const gpu::Program* disc = nullptr;
    const gpu::Program* mip = nullptr;
    gpu::Buffer focus;  ///< layout::FocusBlock (focus_block.h)
};

[[nodiscard]] Result<DepthOfFieldPass> create_depth_of_field_pass(gpu::Device& device);

/// Whether the widest circle of the view's lens can be told from a point.
[[nodiscard]] bool has_depth_of_field(const RenderView& view);

/// The picture through the lens of the view, for which has_depth_of_field.
[[nodiscard]] TextureId draw_depth_of_field(
    FrameGraph& graph, DepthOfFieldPass& pass, const RenderView& view, TextureId radiance,
    TextureId depth);

}  // namespace limn
