#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Spray emission. Each step the systems write the start positions and velocities of new drops;
// whoever moves and draws drops reads them here.
// Techniques: water.crest-spray, water.impact-spray

/// With a Water that has WaterWaves or an Ocean: emits drops from breaking crests.
struct SpraySource {
    float steepness = 0.1f;
    float rate = 300.0f;
    float spread = 0.2f;
    float angle = 0.3f;
    Vec2 window = {60, 60};
};

LIMN_FIELDS(SpraySource) {
    LIMN_FIELD(
        steepness, "height / length above which a wave breaks; an ocean has its foam_threshold", "",
        0, 1);
    LIMN_FIELD(
        rate, "drops per second of a breaking wave, or of 100 m^2 of a cusp of an ocean", "1/s", 0,
        1e6);
    LIMN_FIELD(spread, "variation of speeds: standard deviation / mean", "", 0, 1);
    LIMN_FIELD(angle, "largest deviation of directions", "rad", 0, 1.5);
    LIMN_FIELD(window, "emitting area of unbounded water", "m", 0, 1e5);
}

/// What waves hit: a point of a wall; or, with a WaterTouch or a ParticleCollider that is a ball, a
/// box or a sphere, that body all along its waterline: moles, boulders, hulls. At a point
/// crests of closed-form waves spray as they hit it. On bodies, and in an ocean or ripples, whose
/// crests are not known, the water does that runs against them as fast as in crests; so does a hull
/// that runs into the water.
struct SprayObstacle {
    Vec3 normal = {0, 0, 1};
    float rate = 400.0f;
    float spread = 0.2f;
    float angle = 0.43633231f;
};

LIMN_FIELDS(SprayObstacle) {
    LIMN_FIELD(normal, "wall normal in local space; not of a body with a shape");
    LIMN_FIELD(rate, "drops per second while a crest hits it, all around it", "1/s", 0, 1e6);
    LIMN_FIELD(spread, "variation of speeds: standard deviation / mean", "", 0, 1);
    LIMN_FIELD(angle, "half angle of the cone of directions", "rad", 0, 1.5);
}

/// A drop emitted in this step.
struct SprayDrop {
    Vec3 position = {0, 0, 0};  ///< world space [m]
    Vec3 velocity = {0, 0, 0};  ///< [m/s]
};

/// With a SpraySource or a SprayObstacle, rebuilt each step.
struct SprayDrops {
    std::vector<SprayDrop> drops{};
};

/// Derived from the waves and the frame number.
template <>
struct ComponentTraits<SprayDrops> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
