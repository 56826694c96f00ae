#pragma once

#include "render/effect.h"
#include "render/lens/motion_modes_pass.h"

#include <cstdint>
#include <optional>
#include <variant>

namespace limn {

// Motion blur of a single frame, gathered along two or three directions.
//
// Reads    radiance, depth, velocity
// Writes   radiance: a new texture
// Order    after ripple, before depth of field: the lens images the moving scene
// Shaders  motion_pack.frag, motion_tile.frag, motion_neighbor.frag, motion_blur.frag,
//          lib/motion.glsl
//
// Velocity spans the time between two frames; the exposure is the fraction shutter / 360 of it,
// centered, so a pixel's blur extends over +-v shutter / 720. The maximum velocity of each tile is
// dilated to the tiles that it extends into, so that pixels outside a silhouette know where to
// sample.
//
// A pixel is composed of three layers. In front are surfaces that move across it: a sample blurred
// over a length l covers a point for 1/l of the exposure, so coverages add up. Its own layer are
// pixels with the same motion, whatever their depth: within it, occlusion is that of the frame.
// Where that layer ends within the pixel's own blur, the background shows, estimated by pixels next
// to the silhouette. A static object is thus not affected by motion behind it, nor does it bleed
// into that.
//
// After M. McGuire, P. Hennessy, M. Bukowski, B. Osman, "A Reconstruction Filter for Plausible
// Motion Blur", 2012; J.-P. Guertin, M. McGuire, D. Nowrouzezahrai, "A Fast and Stable
// Feature-Aware Motion Blur Filter", 2014; J. Jimenez, "Next Generation Post Processing in Call of
// Duty: Advanced Warfare", 2014. Limits: motion is assumed straight and uniform, hidden surfaces
// are unknown, and blended surfaces move with the surface behind them.

struct MotionReconstruct {
    const gpu::Program* pack = nullptr;
    const gpu::Program* tile = nullptr;
    const gpu::Program* neighbor = nullptr;
    const gpu::Program* gather = nullptr;

    static Result<MotionReconstruct> create(gpu::Device& device);
    TextureId blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool);
};

/// None if its programs do not compile.
using MotionMethod = std::variant<
    std::monostate, MotionReconstruct, MotionAccumulate, MotionCamera, MotionFlow, MotionStretch>;

/// Motion blur in the mode that the world requests. Skipped for the samples of an accumulated image
/// if these are instants, whose mean is blurred, or if the mode keeps frames.
struct MotionBlurEffect {
    MotionBlur settings = {};                    ///< of the frame
    std::uint64_t last_frame = 0;                ///< FrameData::number of the last blurred one
    std::optional<MotionBlurMode> created = {};  ///< mode of `method`
    MotionMethod method = {};

    static Result<MotionBlurEffect> create(gpu::Device&, const RenderSettings&) {
        return MotionBlurEffect{};
    }
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
};

}  // namespace limn
