#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Throws a stone where Input::pointing meets water, for each click. With a mesh the stone flies
/// from the eye and splashes when it is there; without one the water splashes at once. What stands
/// before the water does not stop the throw.
struct StoneThrower {
    MeshId mesh{};  ///< of a ball with a diameter of 1 m; none: no stone is seen
    MaterialId material{};
    float radius = 0.08f;      ///< of a stone [m], > 0
    float density = 2500.0f;   ///< of a stone [kg/m^3]
    float speed = 14.0f;       ///< how fast stones fly, about [m/s]
    float reach = 60.0f;       ///< how far they can be thrown [m]
    float splash = 1.0f;       ///< height of what they throw up
    std::uint32_t most = 32;   ///< stones at once; the oldest are taken away
    std::uint32_t thrown = 0;  ///< so far
};

/// A stone that was thrown; its number.
struct ThrownStone {
    std::uint32_t number = 0;
};

template <typename Visitor>
void visit_fields(StoneThrower& thrower, Visitor&& visit) {
    visit("mesh", thrower.mesh, {.doc = "a ball with a diameter of 1; none: only the splash"});
    visit("material", thrower.material, {.doc = "of stones"});
    visit("radius", thrower.radius, {.doc = "of a stone", .unit = "m", .min = 0.005, .max = 10});
    visit(
        "density", thrower.density,
        {.doc = "of a stone", .unit = "kg/m^3", .min = 1, .max = 30000});
    visit(
        "speed", thrower.speed,
        {.doc = "how fast they fly, about", .unit = "m/s", .min = 0.5, .max = 200});
    visit(
        "reach", thrower.reach,
        {.doc = "how far they can be thrown", .unit = "m", .min = 0, .max = 10000});
    visit("splash", thrower.splash, {.doc = "height of what they throw up", .min = 0, .max = 100});
    visit("most", thrower.most, {.doc = "stones at once", .min = 0, .max = 10000});
    visit("thrown", thrower.thrown, {.doc = "so far"});
}

template <typename Visitor>
void visit_fields(ThrownStone& stone, Visitor&& visit) {
    visit("number", stone.number, {.doc = "of its throw"});
}

}  // namespace limn
