#pragma once

#include "render/frame_data.h"
#include "render/geometry/gbuffer.h"

#include <vector>

namespace limn {

// Forward lighting after a depth prepass, without a G-buffer: either a loop over objects, each with
// the lights that reach it (LightMethod::ObjectMajor), or a loop over lights, each blended
// additively over the objects that it reaches (LightMethod::LightMajor). Kept for comparison with
// the clusters.
//
// Reads    InstanceList, LightObjects, light records, environment, HighlightMaps
// Writes   depth, radiance: linear; alpha 1 where there is a surface
// Order    instead of the G-buffer and draw_lights()
// Shaders  mesh.vert, depth_first.frag, forward_base.frag, forward_one.frag; with
//          LightMethod::ObjectMajor those of the ShadingRate (shading_rates.h), after
//          facet_depth.geom if they have a geometry shader
//
// The first pass draws depth only; the others draw with depth EQUAL, so that each visible fragment
// is lit once (engine.depth-first). Where surfaces of two objects have exactly the same depth, as
// the tops of overlapping boxes, the stencil lets only the first be lit.

struct ForwardPass {
    std::vector<ProgramVariants> rates = {};  ///< by ShadingRate
    ProgramVariants base;
    ProgramVariants one;
    ProgramVariants vertex_depth;  ///< of rates without a geometry shader
    ProgramVariants facet_depth;   ///< of rates with a geometry shader
    const gpu::Program* nothing = nullptr;
};

[[nodiscard]] Result<ForwardPass> create_forward_pass(gpu::Device& device);

/// Draws all opaque surfaces, whose depth is in view.gbuffer, into view.radiance, and, if two
/// methods of shading are compared, also into `compared`, which is otherwise not valid().
void draw_forward(FrameGraph& graph, ForwardPass& pass, const ViewData& view, TextureId compared);

}  // namespace limn
