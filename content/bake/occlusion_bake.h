#pragma once

#include "content/bake/bake_rows.h"
#include "content/bake/relief_map.h"
#include "content/bake/tile_surface.h"
#include "ecs/base/math.h"

#include <cstdint>
#include <vector>

namespace limn {

// Ambient occlusion: the fraction of the light of a uniform sky, weighted by the cosine, that
// reaches a point. The directions are a Hammersley set, turned about the normal by a hash of the
// texel, so that neighboring texels do not share its pattern.

/// Directions about z with a density that is proportional to their cosine.
[[nodiscard]] std::vector<Vec3> cosine_directions(int count);

/// The directions turned to `normal`, and about it by an angle from `seed`: one of them.
[[nodiscard]] Vec3 turn_to(const Vec3& direction, const Vec3& normal, std::uint32_t seed);

/// R of each texel: 1 where no ray meets anything within `reach`, in widths of the tile. From the
/// surface as `relief` has it: `width` x `height` points, `rays` each.
[[nodiscard]] BakedMap bake_occlusion(
    const TileSurface& tile, const TileCaster& caster, int width, int height, int rays, float reach,
    const RowProgress& progress = {});

}  // namespace limn
