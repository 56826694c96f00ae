#pragma once

#include "ecs/components/ragdoll.h"
#include "ecs/components/skeleton.h"

namespace limn {

/// Poses a character like its ragdoll, by its weight: rotations of the bones, and the place of the
/// first. Bones that are no capsules keep their animated rotations relative to their parents.
void apply_ragdoll(const SkeletonData& skeleton, const RagdollState& state, LocalPose& pose);

}  // namespace limn
