#pragma once

#include "ecs/components/buoyancy.h"
#include "ecs/components/sailing.h"
#include "ecs/components/transform.h"
#include "systems/water/water_query.h"

#include <span>

namespace limn {

// A boat under sail, by itself. Three foils act on the body that step_floating_body floats: the
// sail in the wind, the keel and the rudder in the water. Each is a plate hinged upright: only flow
// across its upright axis counts, so that heeling spills wind. Its force is
//
//     q S (CL(a) l + CD(a) d)        q = rho |u|^2 / 2
//
// along the flow d and across it l, at the angle of attack a: thin-wing lift with induced drag up
// to the stall about 20 degrees, a flat plate in the flow beyond (J. Marchaj, "Aero-hydrodynamics
// of Sailing", 1979). What the foil sees is the flow past the place where it is, so that the wind
// is the apparent one, rolling is damped by the sail and turning by keel and rudder. No foil does
// more in a step than to stop the flow across it: whatever its area, no step makes the boat swing
// back. A hull that makes waves of its own length wants (v / v_hull)^4, v_hull^2 = g L / (2 pi). No
// jib, no flow from sail to sail, no leeway of the rudder in the keel's wake.

inline constexpr float kSlackestBoom = radians(82.0f);  ///< with the sheet let out
inline constexpr float kTightestBoom = radians(8.0f);   ///< hauled in

/// Lift and drag of a foil at the angle of attack `angle` [rad], of any sign.
struct FoilForce {
    float lift = 0;
    float drag = 0;
};
[[nodiscard]] FoilForce foil_force(float angle);

/// Heading of the boat's +z in the world, from +x toward +z [rad]; turning to starboard adds to it.
[[nodiscard]] float heading_of(const Quat& rotation);

/// Where the wind blows to as seen from the boat's sail: 0 from ahead to astern, > 0 to port
/// [rad]. `scale` of the boat.
[[nodiscard]] float apparent_wind_angle(
    const Sailboat& boat, const Floating& floating, const Quat& rotation, const Vec3& scale,
    const Vec3& wind);

/// Lets the boom swing for `step` [s] as far as the sheet lets it, and adds to `floating` what
/// sail, keel and rudder do in it.
void step_sailboat(
    std::span<const WaterSurface> surfaces, const Vec3& wind, const WaterTouch& touch,
    const Transform& transform, float step, Sailboat& boat, Floating& floating);

/// Hauls in and lets out the sheet as the wind wants it.
void trim_sail(
    const Floating& floating, const Quat& rotation, const Vec3& scale, const Vec3& wind, float step,
    Sailboat& boat);

/// Steers along `course`: straight at it where the wind lets it, else by tacks.
void follow_course(
    const PathData& course, const WaterTouch& touch, const Floating& floating,
    const Transform& transform, const Vec3& wind, Sailboat& boat);

}  // namespace limn
