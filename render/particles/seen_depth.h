#pragma once

#include "render/frame_data.h"
#include "render/gpu/ring_buffer.h"
#include "render/gpu/texture.h"
#include "render/shaders/view_gpu.h"

#include <cstdint>
#include <optional>

namespace limn {

namespace gpu {
class Program;
}  // namespace gpu

// What the camera saw in the previous frame, for what meets it in this one before it is drawn
// anew: particles on the GPU (ParticleCollision::collide_depth).

/// Kept from frame to frame.
struct DepthMemory {
    gpu::Texture depth{};                  ///< R32F, as Gbuffer::depth
    layout::ViewBlock camera{};            ///< from which it was seen
    std::optional<std::uint64_t> frame{};  ///< FrameData::number of that frame
};

/// Of the previous frame, for this one.
struct SeenDepth {
    const gpu::Texture* depth = nullptr;  ///< null: nothing was seen
    gpu::RingSlice camera{};              ///< layout::ViewBlock
};

/// Nothing after a cut, or where frames were left out.
[[nodiscard]] SeenDepth recall_depth(const DepthMemory& memory, const FrameData& frame);

/// Adds the pass that copies the depth of a view.
void remember_depth(
    FrameGraph& graph, const gpu::Program& copy, const ViewData& view, DepthMemory& memory);

}  // namespace limn
