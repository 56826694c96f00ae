#pragma once

#include "ecs/components/motion_blur.h"
#include "render/gbuffer.h"
#include "render/gpu/program.h"

namespace limn {

namespace gpu {
class Device;
}  // namespace gpu
struct FrameScene;

// Motion blur of the camera alone, from depth and the two views between which it moved
// (post.motion-blur-camera-psf, after M. Potmesil, I. Chakravarty, "Modeling Motion Blur in
// Computer-Generated Images", 1983): each pixel is the mean of the line along which its point went.
//
// Reads    radiance, depth
// Writes   radiance: a new texture
// Order    where motion blur is
// Shaders  motion_camera.frag, lib/motion.glsl
//
// What stands before or behind another thing bleeds into it, objects that move do not smear, and
// highlights and shadows smear as if they were painted on.

struct MotionCameraPass {
    const gpu::Program* program = nullptr;
};

[[nodiscard]] Result<MotionCameraPass> create_motion_camera_pass(gpu::Device& device);

[[nodiscard]] TextureId blur_camera_motion(
    FrameGraph& graph, const MotionCameraPass& pass, const MotionBlur& settings,
    const FrameScene& scene, const Gbuffer& gbuffer, TextureId radiance);

}  // namespace limn
