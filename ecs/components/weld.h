#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

/// Per position the index of the first one equal to it, which is <= its own. Vertices that a mesh
/// repeats along UV seams so count as one. -0 equals 0; NaN equals NaN of the same bits.
[[nodiscard]] std::vector<std::uint32_t> weld_positions(std::span<const Vec3> positions);

}  // namespace limn
