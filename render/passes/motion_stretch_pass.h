#pragma once

#include "ecs/components/motion_blur.h"
#include "render/frame_scene.h"
#include "render/gbuffer.h"
#include "render/gpu/texture.h"

namespace limn {

// Motion blur by stretched geometry (post.motion-blur-stretch, after S. Green, "Stupid OpenGL
// Shader Tricks", 2003): each moving mesh is drawn once more as the hull of its two poses, and
// inside it the picture before and this one are averaged along the motion.
//
// Reads    radiance, depth; the instances, once more; the picture before, which it keeps
// Writes   radiance: a new texture
// Order    where motion blur is
// Shaders  accumulate.frag, motion_stretch.vert, motion_stretch.frag
//
// The exposure is the time between the two pictures and not centered; `shutter` scales the way that
// is sampled, 360 being the whole. Objects must be closed and smooth, or they tear; motion is
// straight; what stands before an object bleeds into it, and one that goes deep into the picture
// hides its own hull. After a cut this picture stands in for the one before.

struct MotionStretchPass {
    SurfacePrograms hull;
    const gpu::Program* copy = nullptr;
    gpu::Texture before = {};  ///< radiance of the picture before
    bool any = false;          ///< whether `before` holds one
};

[[nodiscard]] Result<MotionStretchPass> create_motion_stretch_pass(gpu::Device& device);

[[nodiscard]] TextureId stretch_motion(
    FrameGraph& graph, MotionStretchPass& pass, const MotionBlur& settings, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance);

/// Forgets the picture before.
void forget_motion(MotionStretchPass& pass);

}  // namespace limn
