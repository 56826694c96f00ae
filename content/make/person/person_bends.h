#pragma once

#include "ecs/components/skeleton.h"
#include "ecs/components/surface.h"

#include <cstdint>

namespace limn {

/// What add_bend_shapes adds.
inline constexpr std::uint16_t kPersonBendShapes = 8;

/// Adds a morph target for each elbow, knee, hip and shoulder, in this order, the left one first,
/// which update_driven_shapes lets follow the joint (bend_shapes.h): outside the bend, skin that
/// two bones share keeps its distance from the joint, as if each vertex turned by its share of the
/// angle; inside, it folds as linear blending does. `mesh` is skinned to all joints of `skeleton`,
/// which rest without rotation.
void add_bend_shapes(MeshData& mesh, const SkeletonData& skeleton);

}  // namespace limn
