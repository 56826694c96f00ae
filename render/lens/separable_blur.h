#pragma once

#include "ecs/base/result.h"
#include "render/graph/frame_graph.h"

#include <array>
#include <string_view>

namespace limn {

namespace gpu {
class Program;
}

// A 7 x 7 blur in two passes of 7 taps (post.separable-blur): 14 reads per pixel instead of 49.
// Exact only for separable kernels. Edges are clamped.
//
// Shaders  separable_blur.frag

/// Weights of the pixels -3 .. 3; they must sum to 1, or the image's brightness changes.
using BlurKernel = std::array<float, 7>;

/// {1, 6, 15, 20, 15, 6, 1} / 64: nearly a Gaussian of standard deviation 1.22 pixels.
inline constexpr BlurKernel kBinomialKernel = {0.015625f, 0.09375f, 0.234375f, 0.3125f,
                                               0.234375f, 0.09375f, 0.015625f};

struct SeparableBlur {
    const gpu::Program* program = nullptr;
};

[[nodiscard]] Result<SeparableBlur> create_separable_blur(gpu::Device& device);

/// The order makes no difference away from the border.
enum class BlurOrder : std::uint8_t { HorizontalFirst, VerticalFirst };

[[nodiscard]] TextureId blur_separable(
    FrameGraph& graph, const SeparableBlur& blur, std::string_view name, TextureId source,
    const BlurKernel& kernel = kBinomialKernel, BlurOrder order = BlurOrder::HorizontalFirst);

}  // namespace limn
