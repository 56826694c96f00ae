#pragma once

#include "ecs/components/mirror_caustic.h"
#include "ecs/components/transform.h"
#include "render/effect.h"

#include <vector>

namespace limn {

// Light that meshes reflect onto a plane (caustic.reflection-plane).
//
// Reads    depth; entities with MirrorCaustic, a mesh and a transform; the first light
// Writes   radiance
// Order    after the sky, before water
// Shaders  mirror_caustic.vert, mirror_caustic.frag, lib/caustic_landing.glsl
//
// This light is not shadowed, and the plane is lit whatever its material; deformed meshes reflect
// in their rest pose.

struct CausticMirror {
    MirrorCaustic settings;
    std::uint32_t mesh = 0;
    Affine world_from_mesh;
};

struct MirrorCausticEffect {
    const gpu::Program* program = nullptr;
    std::vector<CausticMirror> mirrors = {};  ///< of the frame, in world order

    static Result<MirrorCausticEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData&, ViewData& view);
};

}  // namespace limn
