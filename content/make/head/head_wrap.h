#pragma once

#include "content/make/head/head.h"
#include "ecs/base/math.h"

#include <vector>

namespace limn {

/// Positions of the vertices of head_layout() on the skin of a head, at rest [cm]: grows the
/// features out of a plain head while loops relax along the surface; then sets lids, lips and ears,
/// which have their own curves. Symmetric except for HeadShape::asymmetry.
[[nodiscard]] std::vector<Vec3> wrap_head(const HeadShape& shape);

/// Maps a point of a symmetric head to one with HeadShape::asymmetry: one side a little higher,
/// chin and nose shifted a little sideways.
[[nodiscard]] Vec3 skew_head(Vec3 p, const HeadShape& shape);

}  // namespace limn
