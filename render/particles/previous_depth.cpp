#include "render/particles/previous_depth.h"

#include "render/fullscreen.h"
#include "render/light/light_clusters.h"
#include "render/light/light_list.h"
#include "render/shaders/particle_gpu.h"
#include "render/view_block.h"

// Techniques: particle.depth-collision

namespace limn {

PreviousDepth recall_depth(const DepthMemory& memory, const FrameData& frame) {
    const bool follows = memory.frame && *memory.frame + 1 == frame.number && frame.since_last;
    return follows ? PreviousDepth{&memory.depth, frame.ring->push_value(memory.camera)}
                   : PreviousDepth{};
}

void remember_depth(
    FrameGraph& graph, const gpu::Program& copy, const ViewData& view, DepthMemory& memory) {
    const IVec2 size = view.size();
    if (memory.depth.width() != size.x || memory.depth.height() != size.y) {
        memory.depth =
            gpu::Texture("previous depth", {.format = GL_R32F, .width = size.x, .height = size.y});
    }
    memory.camera = make_view_block(view.camera, ClusterShape{}, LightList{}, false);
    memory.frame = view.frame->number;
    add_fullscreen_pass(
        graph, "previous depth", {sampled(view.gbuffer.depth, layout::kParticleDepthUnit)},
        {discarded(graph.import("previous depth", memory.depth))}, &copy);
}

}  // namespace limn
