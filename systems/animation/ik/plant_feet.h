#pragma once

#include "ecs/components/foot_plant.h"
#include "ecs/components/skeleton.h"

namespace limn {

/// Lowers or raises the root by the lower one of both lifts, then bends the legs so that each foot
/// is lifted as its ground is, and turns the feet to the slope.
void apply_foot_plant(
    const SkeletonData& skeleton, const FootPlant& plant, const FootContacts& contacts,
    LocalPose& pose);

}  // namespace limn
