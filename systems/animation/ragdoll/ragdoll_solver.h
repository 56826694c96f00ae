#pragma once

#include "ecs/base/gravity.h"
#include "systems/animation/ragdoll/closest_points.h"
#include "systems/animation/ragdoll/ragdoll_rig.h"

#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace limn {

// Rigid capsules on ball joints by extended position-based dynamics: positions are predicted,
// corrected until anchors, limits and contacts hold, and velocities are what positions did
// (M. Macklin, M. Mueller, N. Chentanez, "XPBD", 2016; M. Mueller, M. Macklin, N. Chentanez, S.
// Jeschke, T.-Y. Kim, "Detailed Rigid Body Simulation with Extended Position Based Dynamics",
// 2020). Beyond them: the anchor of a joint is solved as one block of three equations; a turn at a
// joint leaves its anchor where it is; free bodies keep their angular momentum.
//
// Limits: bodies do not slow down in air; limits and anchors are rigid; energy is lost, by
// impacts, by `damping`, and slowly by the method.
// Techniques: char.dynamics

using RigidQuat = glm::dquat;

/// In the world, double precision; lengths [m], masses [kg].
struct RigidCapsule {
    RigidVec position = RigidVec(0);  ///< of the center of mass
    RigidQuat rotation = RigidQuat(1, 0, 0, 0);
    RigidVec velocity = RigidVec(0);
    RigidVec spin = RigidVec(0);        ///< [rad/s]
    double inverse_mass = 1;            ///< 0: fixed
    double inverse_along = 1;           ///< of the moment of inertia about the segment
    double inverse_across = 1;          ///< about a line across it
    LineSegment segment{};              ///< in the body's space, about the center of mass
    RigidVec axis = RigidVec(0, 1, 0);  ///< of the segment, unit, in the body's space
    double radius = 0.05;
    RigidVec axis_now = RigidVec(0, 1, 0);  ///< the axis in the world; follows `rotation` in steps

    [[nodiscard]] LineSegment placed() const {
        return {position + rotation * segment.from, position + rotation * segment.to};
    }
};

/// A capsule of this mass, at rest. `from` and `to` in the space of the joint, which is at
/// `origin`.
[[nodiscard]] RigidCapsule make_capsule(
    const RigidVec& from, const RigidVec& to, double radius, double mass, const RigidVec& origin,
    const RigidQuat& rotation);

struct RagdollJoint {
    std::size_t parent = 0;
    std::size_t child = 0;
    RigidVec anchor_parent = RigidVec(0);  ///< in the parent's space, from its center of mass
    RigidVec anchor_child = RigidVec(0);
    RigidQuat rest = RigidQuat(1, 0, 0, 0);  ///< of the child relative to the parent
    RagdollLimit limit{};
    double slack = 0;                          ///< by which limits may be exceeded [rad]
    RigidQuat target = RigidQuat(1, 0, 0, 0);  ///< that muscles turn to, relative to the parent
};

/// A capsule touches a surface or another capsule.
struct RagdollContact {
    static constexpr std::size_t kNoBody = ~std::size_t{0};
    std::size_t body = 0;
    std::size_t other = kNoBody;
    RigidVec point = RigidVec(0);  ///< of the body's surface, in its space
    RigidVec under = RigidVec(0);  ///< of the other surface, in the other body's space or the world
    RigidVec normal = RigidVec(0);  ///< unit, toward `body`
    RigidVec moves = RigidVec(0);   ///< velocity of the surface, if it is no body's [m/s]
    bool parts = false;             ///< the surface is between it and another ragdoll

    double pressed = 0;   ///< multiplier along the normal, of this substep
    double rubbed = 0;    ///< along the surface
    double approach = 0;  ///< normal velocity before it [m/s]
};

struct RagdollOptions {
    RigidVec gravity = RigidVec(0, -kGravity, 0);  ///< [m/s^2]
    double friction = 0.6;
    double bounce = 0;
    double damping = 0;              ///< of joints [1/s]
    double muscles = 0;              ///< natural frequency at which joints turn to targets [rad/s]
    double max_depenetration = 1.5;  ///< speed at which overlapping surfaces part [m/s]
};

/// Longest substep [s].
inline constexpr double kRagdollSubstep = 1.0 / 480;

/// Bodies and what joins them. Joints are in the order of their children, parents first.
struct RagdollScene {
    std::vector<RigidCapsule> bodies{};
    std::vector<RagdollJoint> joints{};
    std::vector<RigidVec> forces{};  ///< acceleration of each body beside gravity, or empty
};

/// Finds the contacts of the bodies when `left` [s] of the step are left: appends to `contacts`.
using FindContacts = std::function<void(
    const std::vector<RigidCapsule>& bodies, double left, std::vector<RagdollContact>& contacts)>;

/// Advances the scene by dt >= 0 [s], in substeps. Uses nothing but its arguments.
void step_ragdoll(
    RagdollScene& scene, double dt, const RagdollOptions& options, const FindContacts& find = {});

/// Distance between the two anchors of a joint [m].
[[nodiscard]] double anchor_error(const RagdollScene& scene, const RagdollJoint& joint);

/// By how much a joint is beyond its limits, regardless of slack; 0: within [rad].
[[nodiscard]] double limit_excess(const RagdollScene& scene, const RagdollJoint& joint);

}  // namespace limn
