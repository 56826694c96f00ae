#pragma once

#include "content/bake/bake_rows.h"
#include "content/bake/relief_map.h"

namespace limn {

// Relaxed cones (Policarpo and Oliveira, "Relaxed Cone Stepping for Relief Mapping", GPU Gems 3,
// 2007). A texel's cone has its apex on the surface there and opens toward the viewer, as wide as
// possible such that no ray from the top of this column enters the surface and leaves it again
// within the cone. A march to the cone's boundary therefore passes at most one crossing, which a
// binary search then finds.
//
// For each texel q, a ray from the top of column p to the surface at q is followed to where it
// leaves the surface, at distance r and height h above the apex: r / h bounds the ratio of p.
// Texels and blocks of texels that cannot narrow the cone further are skipped.

/// The map, of any layout with depth in A, in the layout Cone. `repeats`: beyond its edges, else
/// there is nothing. `widest`: the largest ratio; the time grows with its square.
[[nodiscard]] BakedMap make_cone_map(
    const BakedMap& relief, bool repeats, const RowProgress& progress = {}, float widest = 1);

}  // namespace limn
