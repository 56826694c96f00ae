#pragma once

#include "content/make/head/head.h"
#include "ecs/base/math.h"

#include <vector>

namespace limn {

/// Places the vertices of head_layout() on the skin of a head, at rest [cm]: grows the features out
/// of a plain head while loops relax along the surface; then sets lids, lips and ears, which have
/// curves of their own. Symmetric but for HeadShape::asymmetry.
[[nodiscard]] std::vector<Vec3> wrap_head(const HeadShape& shape);

/// Where a point of a symmetric head is on one with HeadShape::asymmetry: one side a little higher,
/// chin and nose a little aside.
[[nodiscard]] Vec3 skew_head(Vec3 p, const HeadShape& shape);

}  // namespace limn
