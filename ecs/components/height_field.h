#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: water.noise-surface

/// Heights above the entity's local plane y = 0 at the points of a square grid about its origin, at
/// the current time. Point (i, j) has index j * points + i. With a MeshInstance: its vertices take
/// the height and normal of the nearest point.
struct HeightField {
    std::uint32_t points = 0;     ///< grid points per side
    Vec2 size = {0, 0};           ///< extent along local x and z [m]
    std::vector<float> height{};  ///< [m]
    std::vector<Vec3> normal{};   ///< unit, up
    float low = 0;                ///< smallest height [m]
    float range = 0;              ///< from the smallest height to the largest [m]
};

/// Derived from settings and the time.
template <>
struct ComponentTraits<HeightField> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
