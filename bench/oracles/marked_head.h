#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"

namespace limn::oracle {

/// How patches over `markers` carry `head`: parts of one head (HeadPartKind). Without places: it
/// could not be bound.
[[nodiscard]] SurfaceBindingState bind_to_markers(const MeshData& head, const MeshData& markers);

}  // namespace limn::oracle
