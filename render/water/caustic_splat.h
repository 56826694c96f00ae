#pragma once

#include "ecs/base/math.h"
#include "render/shaders/caustics_gpu.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// The sum of the light of a map on the CPU, as caustics_splat.comp has it for GPUs: where the CPU
// draws, atomic sums of a shader take ten times as long.

/// Keeps its memory.
struct CausticSums {
    std::vector<std::uint32_t> parts;  ///< of stripes of the grids, one after the other
};

/// Where the rays of all maps land and their light, (cells + 1)^2 a map, to the texels of the atlas
/// that has `width` of them along x: light that arrives over that of flat water. The same for any
/// number of threads. Texels of no map are left alone.
void splat_caustics(
    std::span<const layout::CausticRecord> records, std::span<const Vec4> rays, int width,
    CausticSums& sums, std::span<float> atlas);

}  // namespace limn
