#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/query.h"
#include "ecs/system.h"

#include <span>

namespace limn {

// Weights of morph targets that follow from those of others. Targets move vertices along straight
// lines; an in-between bends the path of one target (a lid that rotates about the eye), a
// corrective corrects a combination (two units that close the same eye) or the bend of a joint
// (bend_shapes.h).

/// Weight of a target with `drivers` while the targets of its list have `weights`: the product of
/// one factor per driver. A peak of 1 gives its weight, from 0 to 1; a lower one a tent that is 0
/// at weights 0 and 1, and 1 at the peak. 0 where a weight is missing or NaN.
[[nodiscard]] float
driven_weight(std::span<const ShapeDriver> drivers, std::span<const float> weights);

/// By how much a joint is bent [rad]: its angle about the axis of this index among its own, from
/// rest, positive to the side of the wider limit. 0 without that axis. `joints`:
/// character_from_joint matrices.
[[nodiscard]] float joint_bend(
    const SkeletonData& skeleton, std::span<const Affine> joints, std::size_t joint,
    std::size_t axis = 0);

/// Writes the weights of all targets with drivers or of bends, of this step and of the previous
/// one. After update_poses.
void update_driven_shapes(
    Query<const Deformed, const MeshInstance> meshes, Query<MorphWeights> faces,
    Query<const Skeleton, const Pose> bodies, Res<const Assets> assets);

}  // namespace limn
