#pragma once

#include "ecs/components/foot_plant.h"
#include "ecs/components/skeleton.h"

#include <cstdint>

namespace limn {

/// How a foot on ground with this normal turns: about the point of the ground below its ankle.
[[nodiscard]] Quat foot_slope(const FootPlant& plant, const Vec3& normal);

/// The highest ankle that turns with the slope; what is higher is carried along [m].
[[nodiscard]] float sloping_height(const SkeletonData& skeleton, std::uint16_t foot);

/// Lowers or raises the root by the lower one of both lifts, then bends the legs so that each foot
/// is lifted as its ground is, and turns the feet to the slope.
void apply_foot_plant(
    const SkeletonData& skeleton, const FootPlant& plant, const FootContacts& contacts,
    LocalPose& pose);

}  // namespace limn
