#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// A body of water: ocean, pool or puddle. Its rest surface is the plane y = 0 of the entity, of
// which position and heading count; what moves it - a spectrum (ocean.h), waves of closed form
// (water_waves.h), ripples (water_ripples.h) - stands beside it and adds up: the point at rest at
// (x, 0, z) is displaced by the sum of theirs.

struct Water {
    Vec2 size = {0, 0};  ///< of the rectangle about the entity, along x and z [m]; 0: without end
    float depth = 0;     ///< of the bottom below the surface [m]; 0: deep
    float refractive_index = 1.333f;
    Vec3 absorption = {0.35f, 0.065f, 0.035f};   ///< of pure water and a little dust [1/m]
    Vec3 scattering = {0.004f, 0.009f, 0.010f};  ///< back to the eye [1/m]
};

/// Whether (x, z), in the water's own space, is over the water.
[[nodiscard]] inline bool is_inside(const Water& water, const Vec2& at) {
    return (water.size.x <= 0 || std::abs(at.x) <= 0.5f * water.size.x)
           && (water.size.y <= 0 || std::abs(at.y) <= 0.5f * water.size.y);
}

template <typename Visitor>
void visit_fields(Water& water, Visitor&& visit) {
    visit(
        "size", water.size,
        {.doc = "along its x and z; 0: without end", .unit = "m", .min = 0, .max = 1e6});
    visit(
        "depth", water.depth,
        {.doc = "of the bottom; 0: deep", .unit = "m", .min = 0, .max = 12000});
    visit(
        "refractive_index", water.refractive_index,
        {.doc = "water 1.333", .min = 1.0001, .max = 4});
    visit(
        "absorption", water.absorption,
        {.doc = "light that is lost on a meter of way", .unit = "1/m", .min = 0, .max = 1000});
    visit(
        "scattering", water.scattering,
        {.doc = "light that comes back from a meter", .unit = "1/m", .min = 0, .max = 1000});
}

}  // namespace limn
