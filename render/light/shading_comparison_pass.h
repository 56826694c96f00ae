#pragma once

#include "ecs/components/shading_comparison.h"
#include "render/effect.h"

namespace limn {

// Two methods of shading in one image, side by side or as their difference.
//
// Reads    ComparedRadiance; ShadingComparison
// Writes   radiance, a new texture
// Order    right after surfaces are lit: sky, water and all later passes are the same for both
// Shaders  shading_comparison.frag
//
// The difference is that of each channel, quantized to 8 bits, raised to a power (thesis, equation
// 6.2, with exponent 1/10). It is stored so that the linear tone curve displays it unchanged.

struct ShadingComparisonEffect {
    const gpu::Program* program = nullptr;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<ShadingComparisonEffect>
    create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
