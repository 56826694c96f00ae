#pragma once

#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Counts shadow volumes in the stencil buffer, light by light, and keeps of each light one layer of
// a mask: 1 where it is seen (shadow.stencil-pass).
//
// Reads    VolumeList, scene depth
// Writes   shadow mask (R8 array); the stencil beside the scene's depth is 0 again after each light
// Order    after the G-buffer and the shadow maps, before whatever is lit
// Shaders  shadow_volume.vert, shadow_mask.frag, shadow_classify.frag, shadow_edge.frag
//
// One draw counts both sides: depth is reversed, so that a volume's front faces that pass the test
// GL_GREATER lie before the scene and add 1, back faces take 1 away (z-pass); or back faces that
// fail it lie behind and add 1, front faces take 1 away (z-fail, with depths clamped to the near
// plane). Counts wrap around, so their order does not matter; 256 volumes one in the other would
// come out as none. Both ends can be mixed, volume by volume.
//
// Where a light cannot reach nothing is counted: a scissor rectangle and, where the device has
// them, depth bounds.
//
// The book lights the scene once a light, with the stencil test (shadow.stencil-frame). Here the
// one deferred pass over all lights reads the mask instead: the same sum of ambient light and each
// light that is seen. Its other form, which darkens a lit picture where any volume counts, is left
// out: it darkens other lights and keeps highlights in the shadow, and would save nothing here.
//
// Hybrid (shadow.hybrid-edge): the map's answer goes to the mask; where its texels disagree, bit 7
// of the stencil is set and only there the volumes are counted, in the seven other bits.

struct ShadowVolumePass {
    SurfacePrograms classify;
    const gpu::Program* edges = nullptr;
    const gpu::Program* volumes[2] = {};  ///< per edge, prisms
    const gpu::Program* layers[2] = {};
    const gpu::Program* mask = nullptr;
};

[[nodiscard]] Result<ShadowVolumePass> create_shadow_volume_pass(gpu::Device& device);

/// A layer for each of scene.volumes.lights; not valid if there is none.
[[nodiscard]] TextureId draw_shadow_volumes(
    FrameGraph& graph, ShadowVolumePass& pass, const FrameScene& scene, const Gbuffer& gbuffer);

/// How many polygons of volumes lie over each pixel, in x: RGBA32F, named "aov.volume_layers".
/// Counts everything that is drawn, hidden or not (shadow.density-view).
[[nodiscard]] TextureId
draw_volume_layers(FrameGraph& graph, const ShadowVolumePass& pass, const FrameScene& scene);

}  // namespace limn
