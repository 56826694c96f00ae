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
    std::vector<std::uint32_t> parts;  ///< of stripes of the grid, one after the other
};

/// Where rays land and their light, (cells + 1)^2 of them, to the side^2 texels of a map: light
/// that arrives over that of flat water. The same for any number of threads.
void splat_caustics(
    const layout::CausticRecord& record,
    std::span<const Vec4> rays,
    CausticSums& sums,
    std::span<float> map);

}  // namespace limn
