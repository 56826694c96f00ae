#pragma once

#include "render/gbuffer.h"
#include "render/gpu/program.h"
#include "render/ripple_list.h"

namespace limn {

struct FrameScene;

// Ripples: the picture behind shock waves, hot air and drops is seen shifted (post.scene-ripple,
// post.glare-heat-haze).
//
// Every ripple adds to a field of shifts [px]; one pass then reads the radiance at the shifted
// places. A ripple shifts nothing that stands in front of it, and no shifted place is read there
// either: of its four texels those in front do not count, and where none is left the pixel stays as
// it is. So what stands in front neither ripples nor leaks into what does, to the bit.
//
//     ring   rays turn away from the shell's center by a sin(2 pi s) (1 - s^2)^2, s = (b - r) / l,
//            b the ray's least distance to the center; times how much of the way to what is seen
//            lies behind the shell
//     haze   two gradient noises at the middle of the ray's way through the region, times the share
//            of that way that is not hidden and the distance to the region's border
//     rain   drops in cells that turn the picture over, some of which run down (by eye)
//     screen post.scene-ripple as the spec has it
//
// Reads    radiance, depth
// Writes   radiance; the field, "ripple.field"
// Order    after everything that is seen through it, before motion blur
// Shaders  ripple_quad.vert with ripple_ring.frag, ripple_haze.frag, ripple_rain.frag,
//          ripple_screen.frag; ripple_grid.vert, .frag; ripple_resolve.frag
//
// Depth and velocity are not moved with it: what comes later takes a shifted pixel for the surface
// that is there. Both are surfaces behind the ripple, so what is in front keeps its outline.

struct RipplePass {
    const gpu::Program* ring = nullptr;
    const gpu::Program* haze = nullptr;
    const gpu::Program* rain = nullptr;
    const gpu::Program* screen = nullptr;
    const gpu::Program* grid = nullptr;
    const gpu::Program* resolve = nullptr;
};

[[nodiscard]] Result<RipplePass> create_ripple_pass(gpu::Device& device);

/// `ripples` are not empty, and live until the frame is drawn.
[[nodiscard]] TextureId draw_ripples(
    FrameGraph& graph, const RipplePass& pass, const RippleList& ripples, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance);

}  // namespace limn
