#pragma once

#include "ecs/base/math.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"

#include <cstddef>
#include <span>
#include <vector>

namespace limn {

// Ragdolls that meet. Each is solved on its own, so that all can be at once: of two capsules that
// would touch in a step, both stay on their side of a plane that moves at their common velocity,
// that of an inelastic impact. The plane knows the masses of the two capsules, not of the chains of
// bones behind them, so that one of both may receive more than the other has lost: what is too much
// is taken from both at their common mass, which does not change how they move relative to each
// other (balance_momentum).

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

/// What a step did to a ragdoll.
struct RagdollOutcome {
    bool gets_up = false;        ///< it has just become inactive
    bool meets = false;          ///< there are planes between it and others
    bool is_free = false;        ///< but for these, nothing touched it
    double mass = 0;             ///< [kg]
    RigidVec received{0, 0, 0};  ///< momentum, beyond that of gravity and forces [kg m/s]
};

/// What to add to the velocities of each ragdoll, so that those that meet, directly or through
/// others, together received nothing; 0 where something else touched one of them, to which the rest
/// went [m/s].
[[nodiscard]] std::vector<RigidVec> balance_momentum(
    std::span<const RagdollOutcome> outcomes, std::span<const std::vector<std::size_t>> neighbors);

}  // namespace limn
