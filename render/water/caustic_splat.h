#pragma once

#include "ecs/base/math.h"
#include "render/shaders/caustics_gpu.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// CPU counterpart of caustics_splat.comp, for OpenGL that runs on the CPU: there, shader atomics
// take ten times as long.

/// Scratch memory, reused.
struct CausticSums {
    std::vector<std::uint32_t> parts;  ///< sums of the stripes of all grids, consecutively
};

/// Sums the light of all maps: `rays` are landing points and light, (cells + 1)^2 per map; `atlas`,
/// `width` texels wide, receives irradiance relative to that under flat water. Deterministic for
/// any number of threads. Texels outside the maps are not written.
void splat_caustics(
    std::span<const layout::CausticRecord> records, std::span<const Vec4> rays, int width,
    CausticSums& sums, std::span<float> atlas);

}  // namespace limn
