#pragma once

#include "ecs/base/math.h"

#include <span>
#include <vector>

namespace limn {

/// Texture coordinates of the nearest point on the skin of the mesh "head", so that maps made for
/// it, such as face_folds, fit other faces. `reference`: positions on the reference face of
/// face_regions.h [cm]; (0, 0) for NaN.
[[nodiscard]] std::vector<Vec2> make_face_chart(std::span<const Vec3> reference);

}  // namespace limn
