#pragma once

#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/graph/frame_graph.h"

namespace limn {

namespace gpu {
class Device;
}  // namespace gpu

// Motion blur as an accumulation buffer makes it: the mean of the last pictures, drawn anyway
// (post.motion-blur-accumulation, method B). Shading and shadows smear rightly too; fast things
// leave discrete copies of themselves behind, which is the method's known fault. The mean of many
// moments within an exposure (method A) is `limn render --spp`.
//
// Reads    radiance
// Writes   radiance: a new texture; a ring of pictures that lasts from frame to frame
// Order    where motion blur is
// Shaders  accumulate.frag, motion_accumulate.frag
//
// The sum is made anew each frame, so that no rounding piles up. After a cut the mean is that of
// the pictures since.

struct MotionAccumulatePass {
    const gpu::Program* copy = nullptr;
    const gpu::Program* mean = nullptr;
    gpu::Texture pictures;  ///< RGBA32F, a layer each
    int newest = -1;        ///< layer
    int count = 0;          ///< layers that hold a picture
};

[[nodiscard]] Result<MotionAccumulatePass> create_motion_accumulate_pass(gpu::Device& device);

/// The mean of the last `window` pictures; `cut`: this one has none before it.
[[nodiscard]] TextureId accumulate_motion(
    FrameGraph& graph, MotionAccumulatePass& pass, int window, bool cut, TextureId radiance);

/// Forgets what it holds: the next picture is the first.
void forget_motion(MotionAccumulatePass& pass);

}  // namespace limn
