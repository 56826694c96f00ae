#pragma once

#include "ecs/components/ink.h"
#include "render/effect.h"

namespace limn {

// Draws the shade of surfaces with the shading model Toon as strokes of ink (Hatching,
// tex.hatching).
//
// Reads    radiance, G-buffer
// Writes   radiance, a new texture
// Order    after opaque surfaces and the sky, before what lies over them
// Shaders  hatching.frag; lib/hatching.glsl, in the G-buffer pass
//
// Strokes lie on the surface, along lines of its texture coordinates, and keep their distance in
// the image. As in the tonal art maps of Praun et al., "Real-Time Hatching", 2001, those of a
// lighter tone are among those of every darker one, and those of a smaller scale among those of
// every larger one: nothing swims or pops as camera and light move. Nested strokes can be stored as
// one number per pixel, the lightest tone that has a stroke there; it takes the place of metalness,
// which Toon does not read.

struct HatchingEffect {
    const gpu::Program* program = nullptr;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<HatchingEffect> create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
