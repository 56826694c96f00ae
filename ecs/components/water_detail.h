#pragma once

#include "ecs/components/surface.h"

#include <cstdint>
#include <vector>

namespace limn {

inline constexpr int kMaxDetailLayers = 4;
inline constexpr int kMaxGeometricWaves = 4;
inline constexpr int kMaxTextureWaves = 16;

/// One of the copies of a normal map that move over the water.
struct DetailLayer {
    float tile = 3;  ///< side of a copy [m]; such that no two layers fit into each other
    float strength = 1;
    float direction = 0;  ///< in which it moves, from +x toward +z [rad]
    float speed = 0.1f;   ///< [m/s]
};

/// Beside a Water: what is too fine to move its surface tilts its normals (water.scrolling-normal-
/// map, water.geometric-texture-split). Caustics and queries know nothing of the layers.
struct WaterDetail {
    ImageId normal_map = {};            ///< that tiles; none: no layers
    std::vector<DetailLayer> layers{};  ///< up to kMaxDetailLayers; their mean counts
    /// Of the waves of WaterWaves those that are shorter are drawn into a texture [m], and all but
    /// the kMaxGeometricWaves longest; up to kMaxTextureWaves. 0: none.
    float split = 0;
    float tile = 8;  ///< after which the waves in that texture repeat [m]
};

template <typename Visitor>
void visit_fields(DetailLayer& layer, Visitor&& visit) {
    visit("tile", layer.tile, {.doc = "side of a copy", .unit = "m", .min = 0.01, .max = 1e4});
    visit("strength", layer.strength, {.doc = "of its tilt", .min = 0, .max = 10});
    visit("direction", layer.direction, {.doc = "it moves, from +x toward +z", .unit = "rad"});
    visit("speed", layer.speed, {.doc = "it moves", .unit = "m/s", .min = 0, .max = 100});
}

template <typename Visitor>
void visit_fields(WaterDetail& detail, Visitor&& visit) {
    visit("normal_map", detail.normal_map, {.doc = "that tiles, moved by layers"});
    visit("layers", detail.layers, {.doc = "up to four"});
    visit(
        "split", detail.split,
        {.doc = "shorter waves tilt normals alone; 0: none", .unit = "m", .min = 0, .max = 1000});
    visit(
        "tile", detail.tile,
        {.doc = "after which those repeat", .unit = "m", .min = 0.01, .max = 1e4});
}

}  // namespace limn
