#pragma once

#include "ecs/base/result.h"
#include "ecs/components/motion_blur.h"
#include "render/frame_data.h"
#include "render/gpu/texture.h"

namespace limn {

// The older modes of MotionBlur, kept for comparison. Each returns a new texture; `follows`: it was
// in use in the previous frame, which this one follows without a cut.

// Motion blur by accumulation: the mean of the last frames (post.motion-blur-accumulation, method
// B). Shading and shadows blur correctly too; fast objects leave discrete ghost copies, the
// method's known fault. The mean of many times within an exposure (method A) is `limn render
// --spp`.
//
// Reads    radiance
// Writes   radiance: a new texture; a ring buffer of frames that persists
// Order    where motion blur is
// Shaders  accumulate.frag, motion_accumulate.frag
//
// The sum is recomputed every frame, so rounding errors do not build up. After a cut the mean is
// over the frames since.

struct MotionAccumulate {
    const gpu::Program* copy = nullptr;
    const gpu::Program* mean = nullptr;
    gpu::Texture frames = {};  ///< ring buffer of frames, RGBA32F layers
    int newest = -1;           ///< layer
    int count = 0;             ///< layers that hold a frame

    static Result<MotionAccumulate> create(gpu::Device& device);
    TextureId
    blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool follows);
};

// Motion blur of the camera only, from depth and its previous and current view
// (post.motion-blur-camera-psf, after M. Potmesil, I. Chakravarty, "Modeling Motion Blur in
// Computer-Generated Images", 1983): each pixel is the mean along the path of its point.
//
// Reads    radiance, depth
// Writes   radiance: a new texture
// Order    where motion blur is
// Shaders  motion_camera.frag, lib/motion.glsl
//
// Limits: foreground bleeds into background and vice versa, moving objects are not blurred, and
// highlights and shadows blur as if they were painted on.

struct MotionCamera {
    const gpu::Program* program = nullptr;

    static Result<MotionCamera> create(gpu::Device& device);
    TextureId blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool);
};

// Motion blur as a line integral along the optical flow computed per vertex
// (post.motion-blur-optic-flow, after C. Shimizu, A. Shesh, B. Chen, "Hardware Accelerated Motion
// Blur Generation", 2003): the image is warped along the field by ever smaller steps and blended
// with itself, and against the field by a quarter of them, so that trailing edges blur more than
// leading ones.
//
// Reads    radiance, depth; the instances, once more
// Writes   radiance: a new texture
// Order    where motion blur is
// Shaders  motion_flow.vert, motion_flow_field.frag, motion_flow.frag, lib/motion.glsl
//
// Only pixels of moving objects change, so nothing blurs beyond its silhouette; surfaces
// parallel to their motion do not blur at all. Camera motion is not included.

struct MotionFlow {
    ProgramVariants field;
    const gpu::Program* warp = nullptr;

    static Result<MotionFlow> create(gpu::Device& device);
    TextureId blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool);
};

// Motion blur by stretched geometry (post.motion-blur-stretch, after S. Green, "Stupid OpenGL
// Shader Tricks", 2003): each moving mesh is drawn once more as the hull of its two poses, and
// inside it the previous and the current frame are averaged along the motion.
//
// Reads    radiance, depth; the instances, once more; the previous frame, which it keeps
// Writes   radiance: a new texture
// Order    where motion blur is
// Shaders  accumulate.frag, motion_stretch.vert, motion_stretch.frag
//
// The exposure is the interval between the two frames, not centered; `shutter` scales the path that
// is sampled, 360 being the whole. Limits: objects must be closed and smooth, or they tear; motion
// is straight; foreground bleeds into the object, and one that moves in depth hides its own hull.
// After a cut the current frame stands in for the previous one.

struct MotionStretch {
    ProgramVariants hull;
    const gpu::Program* copy = nullptr;
    gpu::Texture before = {};  ///< radiance of the previous frame

    static Result<MotionStretch> create(gpu::Device& device);
    TextureId
    blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool follows);
};

}  // namespace limn
