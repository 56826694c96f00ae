#pragma once

#include "ecs/components/motion_blur.h"
#include "render/frame_scene.h"
#include "render/gbuffer.h"

namespace limn {

// Motion blur as a line integral along an optic flow that the vertices know
// (post.motion-blur-optic-flow, after C. Shimizu, A. Shesh, B. Chen, "Hardware Accelerated Motion
// Blur Generation", 2003): the picture is warped along the field by ever smaller steps and mixed
// with itself, and against the field by a quarter of them, so that trailing edges smear more than
// leading ones.
//
// Reads    radiance, depth; the instances, once more
// Writes   radiance: a new texture
// Order    where motion blur is
// Shaders  motion_flow.vert, motion_flow_field.frag, motion_flow.frag, lib/motion.glsl
//
// Only pixels of what moves change, so nothing smears beyond its silhouette; surfaces seen edge on
// to their motion do not smear at all. The camera's motion is no flow.

struct MotionFlowPass {
    SurfacePrograms field;
    const gpu::Program* warp = nullptr;
};

[[nodiscard]] Result<MotionFlowPass> create_motion_flow_pass(gpu::Device& device);

[[nodiscard]] TextureId blur_along_flow(
    FrameGraph& graph, MotionFlowPass& pass, const MotionBlur& settings, const FrameScene& scene,
    const Gbuffer& gbuffer, TextureId radiance);

}  // namespace limn
