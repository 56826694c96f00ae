#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/skeleton.h"

#include <cstddef>

namespace limn {

// Levels of detail of skeletons. Joints are sorted parents first, and a maker of skeletons puts
// those first that are seen from far away: limbs before fingers. A character of less detail has the
// pose of its first joints only. The mesh that it wears then says how many: one whose weights name
// no later joint (SimplifiedShape::joints) needs none.
// Techniques: engine.lod-mesh

/// Makes it a pose of the first `joints`. Joints that it lacked are at rest relative to their
/// parents, where the mesh of the coarser level had them.
void resize_pose(const SkeletonData& skeleton, std::size_t joints, Pose& pose);

/// How many of the first joints of the skeleton a mesh needs: all of its skin up to the last one
/// that has a weight, which the palette holds.
[[nodiscard]] std::size_t needed_joints(const SkinWeights& weights, const SkinData& skin);

}  // namespace limn
