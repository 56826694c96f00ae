#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/light/light_clusters.h"
#include "render/light/light_list.h"
#include "render/light/lighting.h"

namespace limn {

// Builds the light clusters' lists on the GPU, deterministically: no atomics.
//
// Reads    ClusterLights (light_clusters.h)
// Writes   cells (offset and length of each list) and indices into the light records
// Order    before the first pass that includes lib/lighting.glsl
// Shaders  cluster_blocks.comp, cluster_lists.comp, cluster_scan.comp; layout in cluster_gpu.h
//
// Blocks of 32 cells get a bit mask of the lights whose box of cells intersects theirs; each cell
// tests the lights of its block, which counts its list; a prefix sum gives the offset of each list;
// the same test again writes them. So the exact test runs on a few lights per cell instead of all.
// Without point and spot lights nothing runs, and shaders have no light loop.

struct ClusterPass {
    const gpu::Program* blocks = nullptr;
    const gpu::Program* count = nullptr;
    const gpu::Program* scan = nullptr;
    const gpu::Program* fill = nullptr;
    BufferTexture cells = BufferTexture("light cells", GL_RG32UI);
    BufferTexture indices = BufferTexture("light indices", GL_R32UI);
};

[[nodiscard]] Result<ClusterPass> create_cluster_pass(gpu::Device& device);

/// The lists of the light clusters, in buffers of this frame's graph.
struct ClusterLists {
    BufferId cells;    ///< offset and length of each cell's list
    BufferId indices;  ///< the lists one after the other: indices into the light records
    /// The same as buffer textures, once the pass that fills them has run.
    const BufferTexture* cell_texture = nullptr;
    const BufferTexture* index_texture = nullptr;
};

/// Adds the passes; not valid() without point and spot lights.
[[nodiscard]] ClusterLists build_clusters(
    FrameGraph& graph, ClusterPass& pass, const ClusterLights& clusters, const ViewData& view);

/// The lights of the world, once a frame, and of each view its clusters and uniform block.
/// Publishes LightList in the frame; LightingMethod, LightList and ClusterLights in each view.
/// Later effects set the shadows of the view's lights before they are uploaded (light_pass.h).
struct LightListEffect {
    ClusterPass clusters;
    bool dropped_reported = false;

    [[nodiscard]] static Result<LightListEffect> create(gpu::Device& device, const RenderSettings&);
    void collect(FrameData& frame);
    bool prepare(const FrameData& frame, ViewData& view);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

}  // namespace limn
