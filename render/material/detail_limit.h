#pragma once

#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"

namespace limn {

/// What a surface falls to where `limit` is the dearest detail that is drawn. Techniques that are
/// not dearer stay as they are.
[[nodiscard]] SurfaceDetail limited_detail(SurfaceDetail detail, DetailLimit limit);

}  // namespace limn
