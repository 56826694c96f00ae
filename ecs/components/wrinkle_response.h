#pragma once

#include "ecs/components/wrinkle.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Wrinkle maps whose weights follow from what the skin does (skin.pipeline): compression across the
// wrinkles of a region shows the compressed map there, compression along them the stretched one.
// Techniques: skin.pipeline

/// Of an entity with WrinkleMaps and a deformed mesh whose regions have directions.
struct WrinkleResponse {
    float compressed_gain = 1;
    float stretched_gain = 1;
    float bias = 0;
    float smoothing = 0.06f;
    float lambda = 1.05f;
    float beta = 4;
    float share = 0.5f;
};

LIMN_FIELDS(WrinkleResponse) {
    LIMN_FIELD(
        compressed_gain, "on the mean strength of compression across the wrinkles of a region", "",
        0, 10);
    LIMN_FIELD(stretched_gain, "on that along them, whose sign is negative", "", 0, 10);
    LIMN_FIELD(bias, "added to each weight, as wrinkle_weights are", "", -1, 1);
    LIMN_FIELD(smoothing, "time in which a weight goes 63 % of its way; 0: at once", "s", 0, 10);
    LIMN_FIELD(
        lambda, "of the strength at a vertex, see wrinkle_surface; below 1: wrinkles at rest", "",
        0.1, 10);
    LIMN_FIELD(beta, "how suddenly it rises", "", 0.1, 50);
    LIMN_FIELD(
        share,
        "of the maps' influence that the weights of regions have; the rest is left to a "
        "wrinkle_surface with that activation, whose wrinkles are where the skin is compressed",
        "", 0, 1);
}

/// The weights that its maps are drawn with.
struct MeasuredWrinkles {
    WrinkleWeights weights;
    bool started = false;  ///< the first step has nothing to move from
};

LIMN_FIELDS(MeasuredWrinkles) {
    visit_fields(self.weights, visit);
    LIMN_FIELD(started, "has been measured before");
}

/// What the system prepares for each WrinkleResponse.
struct ResponseRest {
    std::array<WrinkleRest, 2> fields;  ///< across the wrinkles, along them
    /// Per vertex: each region's share of its area at rest [m^2].
    std::vector<std::array<float, kWrinkleRegions.size()>> areas;
    std::array<float, kWrinkleRegions.size()> total = {};  ///< [m^2]; 0: too small to measure
    std::uint64_t source = 0;                              ///< hash of what it is made from
};

template <>
struct ComponentTraits<ResponseRest> : DefaultTraits {
    static constexpr bool saved = false;  // follows from the mesh
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
