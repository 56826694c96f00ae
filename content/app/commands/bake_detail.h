#pragma once

#include "ecs/base/result.h"

namespace limn {

struct BakeOptions;

// Shown by `limn bake detail low.obj --high high.obj -o statue.png`: bump.nm-detail-recovery

/// `limn bake detail LOW --high HIGH -o NAME.png`: NAME_normal.png, NAME_height.png,
/// NAME_occlusion.png of the high mesh in the texture space of the low one, and NAME.glb, the low
/// mesh with these maps; see content/bake/detail_bake.h.
Status bake_detail_maps(const BakeOptions& options);

}  // namespace limn
