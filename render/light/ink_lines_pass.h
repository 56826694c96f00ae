#pragma once

#include "ecs/components/ink.h"
#include "render/effect.h"

namespace limn {

// Lines of ink where surfaces end, fold or change their material (InkLines, tex.ink-lines).
//
// Reads    radiance; depth, normals and materials of the G-buffer
// Writes   radiance, a new texture
// Order    after opaque surfaces and the sky, before what lies over them
// Shaders  ink_edges.frag, ink_lines.frag
//
// Edges are between pixels. A depth edge is where either surface is far from the plane of the
// other, so that floors seen at a grazing angle have none. Lines follow the edges on both sides;
// their rims are as soft as a pixel. After Saito and Takahashi, "Comprehensible Rendering of 3-D
// Shapes", 1990.

struct InkLinesEffect {
    const gpu::Program* edges = nullptr;
    const gpu::Program* lines = nullptr;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<InkLinesEffect> create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
