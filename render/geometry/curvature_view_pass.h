#pragma once

#include "ecs/components/curvature_view.h"
#include "render/effect.h"

namespace limn {

// Colors meshes by their curvature (CurvatureView), to check what fit_curvatures() found. Deformed
// meshes, whose curvature is not known, keep their look.
//
// Reads    InstanceList, depth, VertexStream::Curvature
// Writes   radiance
// Order    after all surfaces, before the lens
// Shaders  mesh.vert, curvature_view.frag

struct CurvatureViewEffect {
    ProgramVariants programs;

    [[nodiscard]] static bool is_used(const FrameData& frame);
    [[nodiscard]] static Result<CurvatureViewEffect>
    create(gpu::Device& device, const RenderSettings&);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
