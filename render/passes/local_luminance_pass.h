#pragma once

#include "render/gpu/buffer.h"
#include "render/gpu/program.h"
#include "render/tone.h"

namespace limn {

// Luminance blurred with ten Gaussians, for the dodge-and-burn operator (hdr.dodge-burn).
//
// Reads    radiance
// Writes   three textures of blurs, LocalLuminance
// Order    before the tone map
// Shaders  local_blur.frag, local_shrink.frag; weights in tone_gpu.h
//
// Four blurs share each pair of passes, a component each. The wide ones are made of a picture that
// is blurred already and therefore can be small; variances add, so what is left to do is known.
// They differ from true Gaussians by some percent where a single pixel outshines everything.

struct LocalLuminancePass {
    struct Level {
        const gpu::Program* across = nullptr;
        const gpu::Program* up = nullptr;
        gpu::Buffer weights;  ///< BlurWeights
    };
    Level fine;
    Level middle;
    Level coarse;
    const gpu::Program* shrink = nullptr;
};

[[nodiscard]] Result<LocalLuminancePass> create_local_luminance_pass(gpu::Device& device);

[[nodiscard]] LocalLuminance
blur_luminance(FrameGraph& graph, const LocalLuminancePass& pass, TextureId radiance);

}  // namespace limn
