#pragma once

#include "render/buffer_texture.h"
#include "render/graph/frame_graph.h"
#include "render/skinning/deformed_list.h"

#include <map>

namespace limn {

// Gives every instance whose shape changed its new vertices: morph targets, then joints, as linear
// blends or dual quaternions, any number of each (char.skin-gpu).
//
// Reads    DeformWork, RestPool
// Writes   DeformedVertices: positions, normals, tangents, and positions before if asked for
// Order    before everything that draws meshes
// Shaders  deform.comp, lib/skinning.glsl; layout in deform_gpu.h

struct DeformPass {
    /// By kDeform*; made when first needed. Null: it does not compile, and nothing is deformed.
    std::map<std::uint32_t, const gpu::Program*> programs;
    BufferTexture jobs = BufferTexture("deform jobs", GL_RGBA32UI);
    BufferTexture groups = BufferTexture("deform groups", GL_R32UI);
    BufferTexture rest = BufferTexture("meshes at rest", GL_RGBA32UI);
    BufferTexture palettes = BufferTexture("joint palettes", GL_RGBA32F);
    BufferTexture weights = BufferTexture("morph weights", GL_R32F);
};

[[nodiscard]] Result<DeformPass> create_deform_pass(gpu::Device& device);

/// Adds nothing where no shape changed.
void deform_meshes(FrameGraph& graph, DeformPass& pass, DeformedList& shapes);

}  // namespace limn
