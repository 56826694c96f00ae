#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"

namespace limn::oracle {

/// Binds `head` to patches over `markers`, parts of one head (HeadPartKind). If that fails, the
/// result has no `anchors`.
[[nodiscard]] SurfaceBindingState bind_to_markers(const MeshData& head, const MeshData& markers);

}  // namespace limn::oracle
