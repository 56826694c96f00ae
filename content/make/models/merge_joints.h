#pragma once

#include "ecs/components/skeleton.h"

#include <cstddef>

namespace limn {

/// Passes the weights of all but the first `joints` of the skeleton to the nearest ancestors among
/// those: fingers then move with the hand. The mesh needs no later joint, and at rest stays as it
/// is. Weights without such an ancestor in the skin stay.
void merge_joints(
    SkinWeights& weights, const SkinData& skin, const SkeletonData& skeleton, std::size_t joints);

}  // namespace limn
