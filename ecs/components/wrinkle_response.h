#pragma once

#include "ecs/components/wrinkle.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/reflect.h"

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

// Wrinkle maps whose weights are driven by the skin (skin.pipeline): compression across the
// wrinkles of a region shows the compressed map there, compression along them the stretched one.
// Techniques: skin.pipeline

enum class WrinkleRegion : std::uint8_t {
    LeftBrow,
    RightBrow,
    MiddleBrow,
    Lips,
    LeftCheek,
    RightCheek,
    UpperLeftCheek,
    UpperRightCheek,
    Chin,
};

/// How one region responds, in place of the values of its WrinkleResponse.
struct RegionResponse {
    WrinkleRegion region = WrinkleRegion::LeftBrow;
    float compressed_gain = 1;
    float stretched_gain = 1;
    float bias = 0;
    float smoothing = 0.06f;
};

LIMN_FIELDS(RegionResponse) {
    LIMN_FIELD(
        region, .doc = "region of the masks",
        .values = "left_brow right_brow middle_brow lips left_cheek right_cheek upper_left_cheek "
                  "upper_right_cheek chin");
    LIMN_FIELD(compressed_gain, "as in wrinkle_response", "", 0, 10);
    LIMN_FIELD(stretched_gain, "as in wrinkle_response", "", 0, 10);
    LIMN_FIELD(bias, "as in wrinkle_response", "", -1, 1);
    LIMN_FIELD(smoothing, "as in wrinkle_response", "s", 0, 10);
}

/// On an entity with WrinkleMaps and a deformed mesh whose regions have directions.
struct WrinkleResponse {
    float compressed_gain = 1;
    float stretched_gain = 1;
    float bias = 0;
    float smoothing = 0.06f;
    float lambda = 1.05f;
    float beta = 4;
    float share = 0.5f;
    std::vector<RegionResponse> regions{};
};

LIMN_FIELDS(WrinkleResponse) {
    LIMN_FIELD(
        compressed_gain, "gain of the mean compression across the wrinkles of a region", "", 0, 10);
    LIMN_FIELD(
        stretched_gain, "gain of the mean compression along them, which is subtracted", "", 0, 10);
    LIMN_FIELD(bias, "added to each weight, as wrinkle_weights are", "", -1, 1);
    LIMN_FIELD(
        smoothing, "time constant, in which a weight covers 63 % of a change; 0: at once", "s", 0,
        10);
    LIMN_FIELD(lambda, "as in wrinkle_surface; below 1: wrinkles at rest", "", 0.1, 10);
    LIMN_FIELD(beta, "how abruptly wrinkles rise", "", 0.1, 50);
    LIMN_FIELD(
        share,
        "fraction of the maps' influence that regions have; the rest is for a wrinkle_surface with "
        "that activation, whose wrinkles are where the skin is compressed",
        "", 0, 1);
    LIMN_FIELD(regions, "regions that respond differently");
}

/// The weights with which its maps are drawn.
struct MeasuredWrinkles {
    WrinkleWeights weights;
    bool started = false;  ///< false: the first step does not smooth
};

LIMN_FIELDS(MeasuredWrinkles) {
    visit_fields(self.weights, visit);
    LIMN_FIELD(started, "has been measured before");
}

/// What the system prepares for each WrinkleResponse.
struct ResponseRest {
    std::array<WrinkleRest, 2> fields;  ///< across the wrinkles, along them
    /// Per vertex: its area at rest that belongs to each region [m^2].
    std::vector<std::array<float, kWrinkleRegions.size()>> areas;
    std::array<float, kWrinkleRegions.size()> total = {};  ///< sum [m^2]; 0: too small to measure
    std::uint64_t source = 0;                              ///< hash of what it is made from
};

template <>
struct ComponentTraits<ResponseRest> : DefaultTraits {
    static constexpr bool saved = false;  // follows from the mesh
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
