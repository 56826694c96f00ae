#pragma once

#include "ecs/components/skeleton.h"

namespace limn {

/// Lowers the hips of a standing person, a share `amount`, 0 .. 1, of what a deep squat does; the
/// back leans forward, legs bend and feet stay where they are. Skeletons without hips and two legs
/// (find_body_joints()) keep their pose. Techniques: char.dynamics
void crouch(const SkeletonData& skeleton, float amount, LocalPose& pose);

}  // namespace limn
