#pragma once

#include "content/game/sailing.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/transform.h"
#include "systems/water/water_query.h"

#include <span>

namespace limn {

// Dynamics of one sailboat. Three foils act on the body of step_floating_body: the sail in the
// wind, the keel and the rudder in the water. Each is a plate with an upright hinge: only the flow
// perpendicular to that axis counts, so that heeling spills wind. Its force is
//
//     q S (CL(a) l + CD(a) d)        q = rho |u|^2 / 2
//
// with drag along the flow d and lift perpendicular to it, l, at the angle of attack a: thin-wing
// lift with induced drag up to stall at about 20 degrees, a flat plate beyond (J. Marchaj,
// "Aero-hydrodynamics of Sailing", 1979). The flow is relative to the foil's own motion: the wind
// is the apparent one, rolling is damped by the sail and yawing by keel and rudder. The impulse of
// a foil is limited to stopping its crossflow, so that no step overshoots, whatever the area. The
// wave-making resistance of the hull grows as (v / v_hull)^4, v_hull^2 = g L / (2 pi). No jib, no
// interaction between sails, no wake of the keel at the rudder.

inline constexpr float kMaxBoomAngle = radians(82.0f);  ///< boom angle with the sheet let out
inline constexpr float kMinBoomAngle = radians(8.0f);   ///< with the sheet hauled in

/// Lift and drag coefficients of a foil at the angle of attack `angle` [rad], of either sign.
struct FoilForce {
    float lift = 0;
    float drag = 0;
};
[[nodiscard]] FoilForce foil_force(float angle);

/// World heading of the boat's +z, from +x toward +z [rad]; increases to starboard.
[[nodiscard]] float heading_of(const Quat& rotation);

/// Direction toward which the apparent wind blows at the sail: 0 astern (headwind), > 0 to port
/// [rad]. `scale` is the boat's.
[[nodiscard]] float apparent_wind_angle(
    const Sailboat& boat, const Floating& floating, const FloatingState& motion,
    const Quat& rotation, const Vec3& scale, const Vec3& wind);

/// Swings the boom within the limit of the sheet for `step` [s], and applies the forces of sail,
/// keel and rudder to `motion`.
void step_sailboat(
    std::span<const WaterSurface> surfaces, const Vec3& wind, const WaterTouch& touch,
    const Floating& floating, const Transform& transform, const Sailboat& boat, float step,
    SailboatState& state, FloatingState& motion);

/// Trims the sheet for the apparent wind.
void trim_sail(
    const Sailboat& boat, const Floating& floating, const FloatingState& motion,
    const Quat& rotation, const Vec3& scale, const Vec3& wind, float step, SailboatState& state);

/// Steers along `course`: directly if the wind permits, otherwise by tacking.
void follow_course(
    const PathData& course, const WaterTouch& touch, const FloatingState& motion,
    const Transform& transform, const Vec3& wind, SailboatState& state);

}  // namespace limn
