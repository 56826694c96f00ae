#pragma once

#include "ecs/components/vignette.h"
#include "render/effect.h"

namespace limn {

// Vignetting: the lens passes less light off its axis.
//
// Reads    radiance; Vignette
// Writes   radiance, a new texture
// Order    last in the lens: light that scatters in it (glow, glare) has passed the same pupil
// Shaders  vignette.frag
//
// Natural: a thin lens illuminates the film by cos^4 of the angle to its axis. Mechanical: from
// off the axis, the rim of the lens covers part of the pupil; the open part is the overlap of two
// equal circles, (2/pi) (acos d - d sqrt(1 - d^2)), with their distance d in diameters growing
// from the center of the image to its corners. The center keeps its light.

/// Fraction of the light that passes at `ndc` (-1 .. 1 along x and y), where the half field of view
/// has `tangent` along x and y.
[[nodiscard]] float vignette(const Vignette& settings, const Vec2& ndc, const Vec2& tangent);

struct VignetteEffect {
    const gpu::Program* program = nullptr;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<VignetteEffect> create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
