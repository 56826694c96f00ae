#pragma once

#include "ecs/commands.h"
#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/query.h"
#include "ecs/schedule.h"

namespace limn {

// Prepares meshes whose skin may wrinkle, once and whenever their mesh, map or regions change
// (wrinkle.compression.integration). What skin does is measured by the renderer, which deforms it:
// wrinkle_pass.h.

/// Adds a WrinkleState to each WrinkleSurface whose mesh has one of its regions, and makes it anew
/// where it is out of date. Removes it where the mesh has none. A mesh that has no regions at all
/// wrinkles everywhere, unless the driver is a chord.
void prepare_wrinkles(
    Query<const WrinkleSurface, const MeshInstance> surfaces, Query<const WrinkleState> states,
    Res<const Assets> assets, Commands commands);

// ---- parts of the above ----

/// Of a radial driver: 1 at the center, falling to 0 at `radius` [m] and beyond, by a cosine.
[[nodiscard]] float radial_share(const Vec3& position, const Vec3& center, float radius);

/// Hash of all that a state is made from; 0: the mesh has no such region.
[[nodiscard]] std::uint64_t
wrinkle_source(const WrinkleSurface& surface, const MeshInstance& instance, const Assets& assets);

/// A `resting_shape` that the mesh lacks keeps no folds.
/// Where regions overlap the stronger one gives the direction, and the sum of their weights is cut
/// off at 1. Without a wrinkle map folds are flat.
[[nodiscard]] WrinkleState make_wrinkle_state(
    const WrinkleSurface& surface, const MeshInstance& instance, const Assets& assets);

}  // namespace limn
