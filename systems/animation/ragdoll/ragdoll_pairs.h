#pragma once

#include "ecs/base/math.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Ragdolls that meet. Each is solved on its own, so that all can be at once: of two capsules that
// would touch in a step, both stay on their side of a plane that moves at their common velocity,
// that of an inelastic impact. Two equal bodies so keep their momentum; a chain of bones pushes
// with the mass of the capsule that touches.

/// The capsules of one ragdoll at the beginning of a step.
struct RagdollBodies {
    std::vector<RigidCapsule> bodies{};  ///< empty: meets nobody
    Bounds box{};                        ///< that they stay in during the step [m]
};
[[nodiscard]] RagdollBodies bound_ragdoll(std::vector<RigidCapsule> bodies, double dt);

/// For each ragdoll, the others whose boxes overlap its own, in rising order: a sweep along x.
[[nodiscard]] std::vector<std::vector<std::size_t>>
find_ragdoll_neighbors(std::span<const RagdollBodies> ragdolls);

/// A capsule stays on the side of `normal`, where `point` + t `velocity` is t [s] after the
/// beginning of the step.
struct PartingPlane {
    std::size_t body = 0;
    RigidVec normal{};    ///< unit, from the other capsule
    RigidVec point{};     ///< [m]
    RigidVec velocity{};  ///< of both surfaces once they touch [m/s]
};

/// Adds the planes of all capsules of `own` that meet capsules of `other` within dt [s].
void find_parting_planes(
    const std::vector<RigidCapsule>& own, const std::vector<RigidCapsule>& other, double dt,
    std::vector<PartingPlane>& planes);

}  // namespace limn
