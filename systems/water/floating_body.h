#pragma once

#include "ecs/components/buoyancy.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"
#include "systems/water/water_query.h"

#include <optional>
#include <span>

namespace limn {

// Dynamics of one rigid body in water: buoyancy, drag and contacts.
//
// Buoyancy: every submerged part is pushed along the pressure gradient, up and down the slope of a
// wave, by the weight of the displaced water. A box is cut along its most upright axis into nine
// columns (up to 36 if it is slender) at Gauss-Legendre points, each with its own surface height
// and slope; the submerged part of a column has a closed form, so that volume and moments are exact
// where a plane surface cuts all columns. Balls use closed-form caps.
//
// Motion: semi-implicit Euler in substeps, of momentum and angular momentum; if a body is too light
// for the length of a substep, its inertia is increased. Drag is implicit and therefore stable for
// any step. Wave motion decays with depth, by eye within 1.5 m. No added mass, no lift, no waves of
// its own except splashes and those from WaterTouch.

inline constexpr float kWaterDensity = 1000.0f;  ///< [kg/m^3]

/// Water displaced by a shape.
struct Displaced {
    float volume = 0;         ///< [m^3]
    Vec3 center = {0, 0, 0};  ///< of the displaced volume, world space [m]
    float whole = 0;          ///< total volume of the body [m^3]
};
[[nodiscard]] Displaced
displaced_water(const WaterTouch& touch, const Transform& transform, const WaterSurface& surface);

/// Ripple impulse of a body of `mass` [kg] and `radius` [m] that hits the water at `speed` [m/s]: a
/// crater of 1.5 times its radius, with a depth from its momentum of at most half the crater's
/// radius.
[[nodiscard]] RippleImpulse splash_of(float mass, float radius, float speed);

/// Mass properties of a body.
struct BodyMass {
    float mass = 0;            ///< [kg]
    Vec3 inertia = {0, 0, 0};  ///< about local axes through the center of mass [kg m^2]
    Vec3 center = {0, 0, 0};   ///< center of mass relative to the entity, along local axes [m]
    Vec3 half = {0, 0, 0};     ///< half extents of the shape; of a ball, its radius [m]
};
[[nodiscard]] BodyMass
body_mass(const WaterTouch& touch, const Floating& floating, const Vec3& scale);

/// Impact of a body on the water.
struct Splash {
    std::size_t surface = 0;  ///< index of the surface
    RippleImpulse impulse{};
};

/// Advances a body by `step` [s]: updates `state` and `transform`. Bodies without
/// volume or with positions that are not finite are unchanged.
[[nodiscard]] std::optional<Splash> step_floating_body(
    std::span<const WaterSurface> surfaces, const WaterTouch& touch, const Floating& floating,
    float step, FloatingState& state, Transform& transform);

}  // namespace limn
