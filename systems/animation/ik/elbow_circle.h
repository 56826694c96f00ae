#pragma once

#include "ecs/base/math.h"

namespace limn {

// Two links in space: with shoulder and wrist in place, the elbow of an arm is free to turn on a
// circle about the line between them (the swivel, the seventh degree of freedom of a human arm).
// A pole vector says where it points.
// Techniques: char.elbow-circle, char.ik-two-link

struct ElbowCircle {
    Vec3 center = {0, 0, 0};
    float radius = 0.0f;           ///< 0: the arm is straight
    Vec3 normal = {0, 0, 1};       ///< unit, from shoulder to wrist
    Vec3 toward_pole = {0, 1, 0};  ///< unit, perpendicular to `normal`: swivel 0
    Vec3 sideways = {1, 0, 0};     ///< normal x toward_pole: swivel pi / 2
};

/// The circle for links of these lengths. A wrist too far or too near gets the closest elbow on the
/// line; a pole parallel to the line, or zero, is replaced by some perpendicular.
[[nodiscard]] ElbowCircle make_elbow_circle(
    const Vec3& shoulder, const Vec3& wrist, float upper, float lower, const Vec3& pole);

/// Position of the elbow at an angle about the normal [rad].
[[nodiscard]] Vec3 elbow_at(const ElbowCircle& circle, float swivel);

/// A limb of two links, from its shoulder or hip to its wrist or ankle.
struct LimbPoints {
    Vec3 root = {0, 0, 0};
    Vec3 middle = {0, 1, 0};
    Vec3 tip = {0, 2, 0};
};

struct LimbOptions {
    Vec3 pole = {0, 0, 0};   ///< where the elbow should point; zero: as it is bent now
    Vec3 hinge = {0, 0, 0};  ///< where the limb is straight, it bends about this; zero: any
    float swivel = 0.0f;     ///< of the elbow about the line from root to tip, from the pole [rad]
    float softness = 0.0f;   ///< of the reach [m]
};

/// Where middle and tip must be for the tip to reach `target`, or to come as close as possible; the
/// lengths of the links are kept. For a target that is not finite: unchanged.
[[nodiscard]] LimbPoints
solve_limb(const LimbPoints& limb, const Vec3& target, const LimbOptions& options);

/// Rotations of the upper and the lower link between two poses of a limb: each turns the link and
/// the plane of the limb, so that a hinge in the middle stays perpendicular to that plane. `hinge`:
/// the normal of the plane where a limb is straight; it turns with the upper link.
struct LimbTurn {
    Quat upper = {1, 0, 0, 0};
    Quat lower = {1, 0, 0, 0};
};
[[nodiscard]] LimbTurn
find_limb_turn(const LimbPoints& from, const LimbPoints& to, const Vec3& hinge);

/// The shortest rotation from one direction to another, of any lengths; by half a turn about some
/// perpendicular where they are opposite; the identity where one of them is zero.
[[nodiscard]] Quat rotation_between(const Vec3& from, const Vec3& to);

}  // namespace limn
