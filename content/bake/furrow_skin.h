#pragma once

#include "ecs/commands.h"
#include "ecs/components/furrows.h"
#include "ecs/components/surface.h"
#include "ecs/query.h"
#include "ecs/schedule.h"

#include <vector>

namespace limn {

// Furrows on the entities of a world: after a change, only the steps that depend on it are repeated
// (INTERPOLATE, GENERATE and REMAKE of Bando 2001, section 5.1). Furrows grow on the CPU: each
// depends on all previous ones, which leaves a GPU little parallelism; 512 x 512 take about 30 ms
// on two cores.

/// Gives each Furrows its FurrowSkin. If nothing can be grown, it has a fault, which is logged
/// once, and its images stay unchanged.
void update_furrow_skins(
    Query<const Furrows, const MeshInstance> furrows, Query<FurrowSkin> skins,
    Query<const FurrowView> views, Res<const Assets> assets, Commands commands);

// ---- parts of the above ----

/// The arrows that the fields of vertices without one are interpolated from.
[[nodiscard]] const std::vector<FurrowArrow>& spread_arrows(const Furrows& furrows);
/// The arrows and the style that furrows grow with.
[[nodiscard]] const std::vector<FurrowArrow>& grown_arrows(const Furrows& furrows);
[[nodiscard]] const FurrowStyle& grown_style(const Furrows& furrows);

/// Updates `skin` from `furrows` on `mesh`, for images of `size` pixels along each side; unchanged
/// parts are kept. `flat` affects only the images.
void update_furrow_skin(
    FurrowSkin& skin, const Furrows& furrows, const MeshData& mesh, int size, bool flat);

}  // namespace limn
