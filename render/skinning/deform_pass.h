#pragma once

#include "render/effect.h"
#include "render/gpu/buffer_texture.h"
#include "render/skinning/deformed_list.h"

#include <map>

namespace limn {

// Computes the vertices of every instance whose shape changed: morph targets, then
// deformers (lib/deformers.glsl), then joints, as linear blend or dual quaternion skinning, any
// number of each (char.skin-gpu).
//
// Reads    DeformWork, RestPool
// Writes   DeformedVertices: positions, normals, tangents; previous positions if requested
// Order    before everything that draws meshes
// Shaders  deform.comp, lib/skinning.glsl, lib/deformers.glsl; layout in deform_gpu.h

struct DeformPass {
    /// By kDeform*, loaded on first use. Null: failed to compile, nothing is deformed.
    std::map<std::uint32_t, const gpu::Program*> programs;
    BufferTexture jobs = BufferTexture("deform jobs", GL_RGBA32UI);
    BufferTexture groups = BufferTexture("deform groups", GL_R32UI);
    BufferTexture rest = BufferTexture("meshes at rest", GL_RGBA32UI);
    BufferTexture palettes = BufferTexture("joint palettes", GL_RGBA32F);
    BufferTexture weights = BufferTexture("morph weights", GL_R32F);
    BufferTexture controls = BufferTexture("deformers", GL_RGBA32F);
};

[[nodiscard]] Result<DeformPass> create_deform_pass(gpu::Device& device);

/// Adds no pass if no shape changed. With `warm_up`, first runs the programs that later frames may
/// need; their results are overwritten or unused.
void deform_meshes(FrameGraph& graph, DeformPass& pass, DeformedList& shapes, bool warm_up = false);

/// Deforms meshes once per frame, for all views, which request in prepare() what they draw.
struct DeformEffect {
    DeformPass pass;

    [[nodiscard]] static Result<DeformEffect> create(gpu::Device& device, const RenderSettings&);
    void draw_shared(FrameGraph& graph, const FrameData& frame);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

}  // namespace limn
