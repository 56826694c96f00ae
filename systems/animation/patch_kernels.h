#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface_anchors.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Positions of a mesh on patches (surface_patches.h), for code that needs the deformed surface.
// SIMD moves many vertices of one patch at once, so their anchors are visited patch by patch.

/// Anchors that have a patch, patch by patch.
[[nodiscard]] std::vector<std::uint32_t> order_by_patch(std::span<const SurfaceAnchor> anchors);

/// Positions of the vertices that are bound; the others stay. Both agree within 1e-6 of the size of
/// the patches.
void move_by_patches(const SurfaceShape& shape, std::span<Vec3> positions);
void move_by_patches_scalar(const SurfaceShape& shape, std::span<Vec3> positions);

}  // namespace limn
