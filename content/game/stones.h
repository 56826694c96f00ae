#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// Throws a stone where the ray of Input::pointing hits water, for each click. With a mesh, the
/// stone flies from the camera and splashes on impact; without one, the splash is immediate.
/// Objects in front of the water do not block the throw.
struct StoneThrower {
    MeshId mesh{};
    MaterialId material{};
    float radius = 0.08f;
    float density = 2500.0f;
    float speed = 14.0f;
    float reach = 60.0f;
    float splash = 1.0f;
    std::uint32_t max_stones = 32;
};

LIMN_FIELDS(StoneThrower) {
    LIMN_FIELD(mesh, "mesh of a sphere with a diameter of 1 m; none: only the splash");
    LIMN_FIELD(material, "material of the stones");
    LIMN_FIELD(radius, "radius of a stone", "m", 0.005, 10);
    LIMN_FIELD(density, "density of a stone", "kg/m^3", 1, 30000);
    LIMN_FIELD(speed, "approximate flight speed", "m/s", 0.5, 200);
    LIMN_FIELD(reach, "longest throw", "m", 0, 10000);
    LIMN_FIELD(splash, "factor on the splash height", "", 0, 100);
    LIMN_FIELD(
        max_stones, .doc = "largest number of stones at once; the oldest are removed", .min = 0,
        .max = 10000, .renamed = "most");
}

/// State of a StoneThrower.
struct StoneThrowerState {
    std::uint32_t thrown = 0;
};

LIMN_FIELDS(StoneThrowerState) {
    LIMN_FIELD(thrown, "number thrown so far");
}

/// A thrown stone, numbered in order.
struct ThrownStone {
    std::uint32_t number = 0;
};

LIMN_FIELDS(ThrownStone) {
    LIMN_FIELD(number, "number of its throw");
}

}  // namespace limn
