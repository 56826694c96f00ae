#pragma once

#include "render/frame_data.h"

namespace limn {

// Counts shadow volumes in the stencil buffer, one light at a time, into a shadow mask with one
// layer per light: 1 where it is lit (shadow.stencil-pass).
//
// Reads    VolumeList, scene depth
// Writes   shadow mask (R8 array); the scene's stencil is reset to 0 after each light
// Order    after the G-buffer and the shadow maps, before lighting
// Shaders  shadow_volume.vert, shadow_mask.frag, shadow_classify.frag, shadow_edge.frag
//
// One draw counts both sides. Depth is reversed, so a volume's front faces that pass GL_GREATER lie
// in front of the scene and increment, back faces decrement (z-pass); or back faces that fail it
// lie behind and increment, front faces decrement (z-fail, with depth clamped to the near plane).
// Counts wrap around, so their order does not matter; 256 nested volumes would alias to none. Both
// methods can be mixed, per volume.
//
// Counting is limited to the light's range by a scissor rectangle and, if supported, depth bounds.
//
// The book lights the scene once per light with the stencil test (shadow.stencil-frame). Here the
// single deferred pass over all lights reads the mask instead: the same sum of ambient light and
// each unshadowed light. Its other variant, which darkens a lit image where any volume counts, is
// left out: it also darkens other lights, keeps highlights in shadow, and would save nothing here.
//
// Hybrid (shadow.hybrid-edge): the shadow map's result goes to the mask; where its texels disagree,
// bit 7 of the stencil is set and volumes are counted only there, in the other seven bits.

struct ShadowVolumePass {
    ProgramVariants classify;
    const gpu::Program* edges = nullptr;
    const gpu::Program* volumes[2] = {};  ///< by VolumeRun::prisms: per edge, per triangle
    const gpu::Program* layers[2] = {};
    const gpu::Program* mask = nullptr;
    gpu::Texture no_masks{};  ///< a layer, bound where no light in view has volumes
};

[[nodiscard]] Result<ShadowVolumePass> create_shadow_volume_pass(gpu::Device& device);

/// A layer for each light of the view's VolumeList, which must not be empty.
[[nodiscard]] TextureId
draw_shadow_volumes(FrameGraph& graph, ShadowVolumePass& pass, const ViewData& view);

}  // namespace limn
