#pragma once

#include "ecs/components/buoyancy.h"
#include "ecs/components/transform.h"
#include "ecs/components/water_ripples.h"
#include "systems/water/water_query.h"

#include <optional>
#include <span>

namespace limn {

// A rigid body in the water, by itself: what holds it up, and a step of it.
//
// Archimedes: every part under water is pushed along the gradient of the pressure, by the weight of
// the water that it displaces - up, and down the slope of a wave. A box is cut into nine columns,
// four times as many where it is slender, along its most upright axis, at the points of
// Gauss-Legendre's rule, each with its own height and
// slope of the surface; the part of a column under water has a closed form, so that volume and
// moments are exact where a plane surface cuts all columns. Balls have the closed form of caps.
// Motion: semi-implicit Euler in sub-steps, of momentum and angular momentum; what is so light that
// a sub-step is too long for it counts as heavier when it is to be moved. Resistance is implicit,
// so it brings to rest whatever the step. Below a wave water calms down, by eye within 1.5 m.
// No added mass, no lift, no waves of its own but splashes and what WaterTouch makes.

inline constexpr float kWaterDensity = 1000.0f;  ///< [kg/m^3]

/// What a shape displaces of a surface that is a plane: still water.
struct Displaced {
    float volume = 0;         ///< [m^3]
    Vec3 center = {0, 0, 0};  ///< of it, in the world [m]
    float whole = 0;          ///< volume of the body [m^3]
};
[[nodiscard]] Displaced
displaced_water(const WaterTouch& touch, const Transform& transform, const WaterSurface& surface);

/// What a body of `mass` [kg] and `radius` [m] does to ripples when it falls in at `speed` [m/s]: a
/// crater 1.5 times as wide, as deep as its momentum makes it and never deeper than half its width.
[[nodiscard]] RippleImpulse splash_of(float mass, float radius, float speed);

/// What impulses move of a body.
struct BodyMass {
    float mass = 0;            ///< [kg]
    Vec3 inertia = {0, 0, 0};  ///< about its own axes, through its center [kg m^2]
    Vec3 center = {0, 0, 0};   ///< of mass, from the entity's place in its own axes [m]
};
[[nodiscard]] BodyMass
body_mass(const WaterTouch& touch, const Floating& floating, const Vec3& scale);

/// A body has fallen into the water.
struct Splash {
    std::size_t surface = 0;  ///< which
    RippleImpulse impulse{};
};

/// Moves a body by `step` [s]: `floating`'s velocities and `transform`. Bodies without volume, and
/// those that are nowhere, stay as they are.
[[nodiscard]] std::optional<Splash> step_floating_body(
    std::span<const WaterSurface> surfaces, const WaterTouch& touch, float step, Floating& floating,
    Transform& transform);

}  // namespace limn
