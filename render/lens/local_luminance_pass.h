#pragma once

#include "ecs/base/result.h"
#include "render/gpu/buffer.h"
#include "render/gpu/program.h"
#include "render/graph/frame_graph.h"

namespace limn {

// Luminance blurred with ten Gaussians, for the dodge-and-burn operator (hdr.dodge-burn).
//
// Reads    radiance
// Writes   three textures of blurs, LocalLuminance
// Order    before the tone map
// Shaders  local_blur.frag, local_shrink.frag; weights in tone_gpu.h
//
// Four blurs share each pair of passes, one per channel. The wide ones start from an image that is
// already blurred and can therefore be smaller; variances add, so the remaining blur is known. The
// results differ from true Gaussians by some percent around a single very bright pixel.

/// Luminance blurred for dodge and burn: scale i is a Gaussian of variance 1.6^(2 i) / 16 [px^2].
struct LocalLuminance {
    TextureId fine;    ///< scales 0 .. 3, full resolution
    TextureId medium;  ///< 4 .. 7, half resolution
    TextureId coarse;  ///< 8 and 9, quarter resolution
};

struct LocalLuminancePass {
    struct Level {
        const gpu::Program* across = nullptr;
        const gpu::Program* up = nullptr;
        gpu::Buffer weights;  ///< BlurWeights
    };
    Level fine;
    Level medium;
    Level coarse;
    const gpu::Program* downsample = nullptr;
};

[[nodiscard]] Result<LocalLuminancePass> create_local_luminance_pass(gpu::Device& device);

[[nodiscard]] LocalLuminance
blur_luminance(FrameGraph& graph, const LocalLuminancePass& pass, TextureId radiance);

}  // namespace limn
