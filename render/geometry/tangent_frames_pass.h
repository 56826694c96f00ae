#pragma once

#include "ecs/components/tangent_frames.h"
#include "render/effect.h"

namespace limn {

// Draws the tangent, bitangent and normal of every vertex (TangentFrames), to check them.
//
// Reads    InstanceList, depth
// Writes   radiance
// Order    after all surfaces, before the lens
// Shaders  mesh.vert, tangent_frames.geom, tangent_frames.frag

struct TangentFramesEffect {
    ProgramVariants programs;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<TangentFramesEffect>
    create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
