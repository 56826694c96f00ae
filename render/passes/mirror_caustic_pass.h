#pragma once

#include "ecs/components/mirror_caustic.h"
#include "render/frame_scene.h"
#include "render/gbuffer.h"

#include <vector>

namespace limn {

class World;

// Light that meshes mirror onto a plane (caustic.reflection-plane).
//
// Reads    depth; entities with MirrorCaustic, a mesh and a place; the first light
// Writes   radiance
// Order    after the sky, before water
// Shaders  mirror_caustic.vert, mirror_caustic.frag, lib/caustic_landing.glsl
//
// Nothing stands in the way of this light, and the plane is lit whatever it is made of; meshes that
// change their shape mirror as they were made. The program is made when there is a mirror for the
// first time.

struct CausticMirror {
    MirrorCaustic settings;
    std::uint32_t mesh = 0;
    Affine world_from_mesh;
};

struct MirrorCausticPass {
    const gpu::Program* program = nullptr;
    bool failed = false;  ///< to compile: logged, no mirrors
    std::vector<CausticMirror> mirrors;
};

/// Those of the world at the moment that `alpha` says, in world order.
void collect_mirrors(const World& world, float alpha, std::vector<CausticMirror>& mirrors);

/// Draws over `radiance`; adds no pass without mirrors or light.
void draw_mirror_caustics(
    FrameGraph& graph, gpu::Device& device, MirrorCausticPass& pass, const FrameScene& scene,
    TextureId radiance, const Gbuffer& gbuffer);

}  // namespace limn
