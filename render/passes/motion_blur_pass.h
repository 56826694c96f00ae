#pragma once

#include "ecs/components/motion_blur.h"
#include "render/gbuffer.h"
#include "render/gpu/program.h"

namespace limn {

namespace gpu {
class Device;
}  // namespace gpu
struct FrameScene;

// Smears what moves while the shutter is open, by gathering along two ways or three.
//
// Reads    radiance, depth, velocity
// Writes   radiance: a new texture
// Order    after ripple, before depth of field: the lens sees a moving picture
// Shaders  motion_pack.frag, motion_tile.frag, motion_neighbor.frag, motion_blur.frag,
//          lib/motion.glsl
//
// Velocity goes over the time between two pictures; the exposure is the share shutter / 360 of it
// and centered, so that a pixel's smear reaches +-v shutter / 720. The longest motion of each tile
// is spread to the tiles that it gets to, which tells the pixels outside a silhouette where to
// look.
//
// A pixel then sees three layers. In front is what gets here from elsewhere: a sample that smears
// over a length l passes a point for 1/l of the exposure, so shares of the exposure add up. Its own
// layer is what moves alike, whatever its depth: in it, nothing hides more or less than at the
// moment drawn. Where that layer ends within the pixel's own smear, what is behind it shows, taken
// from beside the silhouette as the nearest guess. A still object is thus neither touched by what
// moves behind it nor does it bleed into that.
//
// After M. McGuire, P. Hennessy, M. Bukowski, B. Osman, "A Reconstruction Filter for Plausible
// Motion Blur", 2012; J.-P. Guertin, M. McGuire, D. Nowrouzezahrai, "A Fast and Stable
// Feature-Aware Motion Blur Filter", 2014; J. Jimenez, "Next Generation Post Processing in Call of
// Duty: Advanced Warfare", 2014. Motion is taken for straight and even, hidden surfaces are not
// known, and what is blended moves with what is behind it.

struct MotionBlurPass {
    const gpu::Program* pack = nullptr;
    const gpu::Program* tile = nullptr;
    const gpu::Program* neighbor = nullptr;
    const gpu::Program* blur = nullptr;
};

[[nodiscard]] Result<MotionBlurPass> create_motion_blur_pass(gpu::Device& device);

/// `gbuffer` must have velocity.
[[nodiscard]] TextureId blur_motion(
    FrameGraph& graph, const MotionBlurPass& pass, const MotionBlur& settings,
    const FrameScene& scene, const Gbuffer& gbuffer, TextureId radiance);

}  // namespace limn
