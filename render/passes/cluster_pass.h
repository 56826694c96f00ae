#pragma once

#include "render/frame_scene.h"

namespace limn {

// Makes the light clusters' lists on the GPU, the same bits every time: no atomics.
//
// Reads    ClusterLights (light_clusters.h)
// Writes   cells (begin and length of each list) and indices into the light records
// Order    before the first pass that includes lib/lighting.glsl
// Shaders  cluster_blocks.comp, cluster_lists.comp, cluster_scan.comp; layout in cluster_gpu.h
//
// Blocks of 32 cells get the bits of the lights whose box of cells meets theirs; each cell tests
// the lights of its block, which counts its list; a prefix sum says where each list begins; the
// same test again writes them. So the exact test runs on a few lights a cell instead of all.
// Does nothing, and costs nothing, where no light is placed: shaders then have no loop.

struct ClusterPass {
    const gpu::Program* blocks = nullptr;
    const gpu::Program* count = nullptr;
    const gpu::Program* scan = nullptr;
    const gpu::Program* fill = nullptr;
    BufferTexture lights = BufferTexture("cluster lights", GL_RGBA32F);
    BufferTexture boxes = BufferTexture("cluster boxes", GL_RG32UI);
    BufferTexture cells = BufferTexture("light cells", GL_RG32UI);
    BufferTexture indices = BufferTexture("light indices", GL_R32UI);
};

[[nodiscard]] Result<ClusterPass> create_cluster_pass(gpu::Device& device);

/// Adds the passes for the lights of `scene.clusters`, whose slices `pass.lights` and `pass.boxes`
/// must show.
[[nodiscard]] ClusterLists
build_clusters(FrameGraph& graph, ClusterPass& pass, const FrameScene& scene);

}  // namespace limn
