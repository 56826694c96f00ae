#pragma once

#include "ecs/base/math.h"

#include <vector>

namespace limn {

struct Material;

// The parts of a material's record that only some materials have (shaders/material_blocks_gpu.h).
// Materials without them need neither the memory nor the shader code.

/// Appends the blocks of `material` to `blocks`. Returns MaterialRecord::blocks, its x counted from
/// the front of `blocks`.
[[nodiscard]] Vec4 append_blocks(const Material& material, std::vector<Vec4>& blocks);

/// Whether the roughness of its surface samples is not its own but that of the bumps which mip
/// levels of its normal map average (normal_mips.h): it lowers the shininess.
[[nodiscard]] bool has_wide_highlights(const Material& material);

}  // namespace limn
