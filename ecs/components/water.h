#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

namespace limn {

// A body of water: ocean, pool or puddle. Its rest surface is the plane y = 0 of the entity; only
// the entity's position and heading count. Spectral waves (ocean.h), closed-form waves
// (water_waves.h) and ripples (water_ripples.h) are further components of the same entity: the rest
// point (x, 0, z) is displaced by the sum of their displacements.

struct Water {
    Vec2 size = {0, 0};
    float depth = 0;
    float refractive_index = 1.333f;
    Vec3 absorption = {0.35f, 0.065f, 0.035f};
    Vec3 scattering = {0.004f, 0.009f, 0.010f};
};

LIMN_FIELDS(Water) {
    LIMN_FIELD(size, "extent along local x and z; 0: unbounded", "m", 0, 1e6);
    LIMN_FIELD(depth, "depth of the bottom; 0: infinitely deep", "m", 0, 12000);
    LIMN_FIELD(refractive_index, "index of refraction; water 1.333", "", 1.0001, 4);
    LIMN_FIELD(absorption, "absorption coefficient", "1/m", 0, 1000);
    LIMN_FIELD(scattering, "backscattering coefficient", "1/m", 0, 1000);
}

/// Whether (x, z), in the water's local space, is within its rectangle.
[[nodiscard]] inline bool is_inside(const Water& water, const Vec2& at) {
    return (water.size.x <= 0 || std::abs(at.x) <= 0.5f * water.size.x)
           && (water.size.y <= 0 || std::abs(at.y) <= 0.5f * water.size.y);
}

}  // namespace limn
