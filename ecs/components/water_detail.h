#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

// Techniques: water.geometric-texture-split, water.scrolling-normal-map

inline constexpr int kMaxDetailLayers = 4;
inline constexpr int kMaxGeometricWaves = 4;
inline constexpr int kMaxTextureWaves = 16;

/// One scrolling layer of the normal map.
struct DetailLayer {
    float tile = 3;  ///< side length of a tile [m]; avoid integer ratios between layers
    float strength = 1;
    float direction = 0;
    float speed = 0.1f;
};

LIMN_FIELDS(DetailLayer) {
    LIMN_FIELD(tile, "side length of a tile", "m", 0.01, 1e4);
    LIMN_FIELD(strength, "strength of the normal perturbation", "", 0, 10);
    LIMN_FIELD(direction, "scrolling direction, from +x toward +z", "rad");
    LIMN_FIELD(speed, "scrolling speed", "m/s", 0, 100);
}

/// With a Water: detail too fine for displacement perturbs the normals instead
/// (water.scrolling-normal-map, water.geometric-texture-split). Caustics and queries ignore the
/// layers.
struct WaterDetail {
    ImageId normal_map = {};
    std::vector<DetailLayer> layers{};  ///< up to kMaxDetailLayers; averaged
    /// Waves of WaterWaves shorter than this [m], and all but the kMaxGeometricWaves longest, are
    /// rendered into a normal texture instead, up to kMaxTextureWaves of them. 0: none.
    float split = 0;
    float tile = 8;
};

LIMN_FIELDS(WaterDetail) {
    LIMN_FIELD(normal_map, "tileable normal map, scrolled by the layers");
    LIMN_FIELD(layers, "scrolling layers, up to four");
    LIMN_FIELD(split, "shorter waves only perturb normals; 0: none", "m", 0, 1000);
    LIMN_FIELD(tile, "period of the texture of those waves", "m", 0.01, 1e4);
}

}  // namespace limn
