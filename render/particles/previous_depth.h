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

// The depth of the previous frame, with which particles on the GPU collide before this frame is
// drawn (ParticleCollision::collide_depth).

/// Kept from frame to frame.
struct DepthMemory {
    gpu::Texture depth{};                  ///< R32F, as Gbuffer::depth
    layout::ViewBlock camera{};            ///< of that frame
    std::optional<std::uint64_t> frame{};  ///< FrameData::number of that frame
};

/// For this frame.
struct PreviousDepth {
    const gpu::Texture* depth = nullptr;  ///< null: not available
    gpu::RingSlice camera{};              ///< layout::ViewBlock
};

/// None after a cut, or if frames were skipped.
[[nodiscard]] PreviousDepth recall_depth(const DepthMemory& memory, const FrameData& frame);

/// Adds the pass that copies the depth of a view.
void remember_depth(
    FrameGraph& graph, const gpu::Program& copy, const ViewData& view, DepthMemory& memory);

}  // namespace limn
