#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

/// Beside a WaterTouch, which says its shape, on an entity without a parent: falls through air,
/// floats on water, or sinks to the bottom of it. Mass is density times the volume of the shape,
/// spread evenly.
struct Floating {
    float density = 500.0f;  ///< [kg/m^3]; water has 1000
    Vec3 balance = {
        0, 0, 0};           ///< center of mass, from the middle of the shape in its own space [m]
    Vec3 drag = {1, 1, 1};  ///< resistance coefficients along its own axes; a keel has a large x
    float damping = 0.4f;   ///< rate at which motion against the water fades, afloat [1/s]
    float splash = 1.0f;    ///< height of what it throws up when it falls in; 0: nothing
    bool stays = true;      ///< is held back by the edges of the water that it is in
    Vec3 velocity = {0, 0, 0};  ///< of the center of mass [m/s]
    Vec3 spin = {0, 0, 0};      ///< about the world's axes [rad/s]
    float under = 0.0f;         ///< share of its volume that is under water
};

template <typename Visitor>
void visit_fields(Floating& floating, Visitor&& visit) {
    visit(
        "density", floating.density,
        {.doc = "water has 1000", .unit = "kg/m^3", .min = 1, .max = 30000});
    visit(
        "balance", floating.balance,
        {.doc = "center of mass from the middle of the shape, in its own space", .unit = "m"});
    visit(
        "drag", floating.drag,
        {.doc = "resistance of water along its own axes", .min = 0, .max = 1000});
    visit(
        "damping", floating.damping,
        {.doc = "how fast motion against the water fades, afloat",
         .unit = "1/s",
         .min = 0,
         .max = 100});
    visit(
        "splash", floating.splash,
        {.doc = "height of what it throws up when it falls in", .min = 0, .max = 100});
    visit("stays", floating.stays, {.doc = "is held back by the edges of the water"});
    visit("velocity", floating.velocity, {.doc = "of its center of mass", .unit = "m/s"});
    visit("spin", floating.spin, {.doc = "about the world's axes", .unit = "rad/s"});
    visit(
        "under", floating.under,
        {.doc = "share of its volume that is under water", .min = 0, .max = 1});
}

}  // namespace limn
