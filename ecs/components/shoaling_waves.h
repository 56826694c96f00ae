#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: water.shallow-refraction

/// Waves of one period that run over a round shoal, as in a ripple tank: over it they are shorter
/// and slower, and their crests turn toward it (water.shallow-refraction). Fills a HeightField.
struct ShoalingWaves {
    Vec2 size = {4, 4};
    std::uint32_t points = 97;
    float period = 0.6f;
    float direction = 0;
    float amplitude = 0.01f;
    float depth = 0.4f;
    float shoal_depth = 0.06f;
    float shoal_radius = 1.2f;
    bool operator==(const ShoalingWaves&) const = default;
};

LIMN_FIELDS(ShoalingWaves) {
    LIMN_FIELD(size, "extent along local x and z", "m", 0.01, 1e5);
    LIMN_FIELD(points, "grid points per side", "", 2, 1024);
    LIMN_FIELD(period, "period of the waves", "s", 0.01, 1e3);
    LIMN_FIELD(direction, "direction of travel, from +x toward +z", "rad");
    LIMN_FIELD(amplitude, "half the crest-to-trough height", "m", 0, 100);
    LIMN_FIELD(depth, "depth away from the shoal", "m", 0.05, 12000);
    LIMN_FIELD(shoal_depth, "depth at the center of the shoal", "m", 0.05, 12000);
    LIMN_FIELD(shoal_radius, "radius at which the bottom has fallen to the depth", "m", 0, 1e5);
}

/// With a ShoalingWaves: the train over its bottom, which no time changes.
struct ShoalingState {
    ShoalingWaves settings;    ///< that it was made for
    std::vector<float> phase;  ///< at each point, without omega t [rad]
    double frequency = 0;      ///< omega [rad/s]
};

template <>
struct ComponentTraits<ShoalingState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
