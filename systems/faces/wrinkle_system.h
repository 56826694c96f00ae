#pragma once

#include "ecs/commands.h"
#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/query.h"
#include "ecs/schedule.h"

namespace limn {

// Prepares meshes whose skin may wrinkle, once and whenever their mesh, map or regions change
// (wrinkle.compression.integration). The renderer, which deforms the skin, measures it:
// wrinkle_pass.h.

/// Adds a WrinkleState to each WrinkleSurface whose mesh has one of its regions, and rebuilds it
/// when it is out of date. Removes it where the mesh has none. A mesh without any regions wrinkles
/// everywhere, unless the driver is a chord.
void prepare_wrinkles(
    Query<const WrinkleSurface, const MeshInstance> surfaces, Query<const WrinkleState> states,
    Res<const Assets> assets, Commands commands);

// ---- parts of the above ----

/// For a radial driver: falls by a cosine from 1 at the center to 0 at `radius` [m] and beyond.
[[nodiscard]] float radial_falloff(const Vec3& position, const Vec3& center, float radius);

/// Hash of everything a state is made from; 0: the mesh has no such region.
[[nodiscard]] std::uint64_t
wrinkle_source(const WrinkleSurface& surface, const MeshInstance& instance, const Assets& assets);

/// If the mesh lacks the `resting_shape`, no folds remain at rest.
/// Where regions overlap, see merge_regions. Without a wrinkle map folds are flat.
[[nodiscard]] WrinkleState make_wrinkle_state(
    const WrinkleSurface& surface, const MeshInstance& instance, const Assets& assets);

}  // namespace limn
