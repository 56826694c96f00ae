#pragma once

#include "ecs/base/math.h"

#include <span>
#include <vector>

namespace limn {

/// Texture coordinates that the skin of the mesh "head" has at its nearest point, so that maps made
/// for it, as face_folds, suit other faces. `reference`: places on the reference face of
/// face_regions.h [cm]; (0, 0) for NaN.
[[nodiscard]] std::vector<Vec2> make_face_chart(std::span<const Vec3> reference);

}  // namespace limn
