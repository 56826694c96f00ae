#pragma once

#include "ecs/components/wrinkle.h"
#include "render/material/surface_hooks.h"

#include <cstdint>
#include <vector>

namespace limn {

// What wrinkles add to the programs of surfaces (surface_hooks.h): where a deformed instance
// wrinkles, its color and normal are those of its wrinkle map, and folds move its vertices.
// lib/wrinkle_surface.glsl explains the definitions.

/// Bits of kWrinkleHook; of an instance without wrinkles none.
enum WrinkleFeature : std::uint16_t {
    kWrinkled = 1u << 0,  // draws wrinkles by any method; has no definition
    kWrinkleBlend = 1u << 1,
    kWrinkleFade = 1u << 2,
    kWrinkleFlat = 1u << 3,
    kWrinkleView = 1u << 4,         // needs no wrinkle map
    kWrinkleDisplaced = 1u << 5,    // folds move its vertices
    kWrinkleColumns = 1u << 6,      // each column of the image has a method of its own
    kWrinkleModel = 1u << 7,        // the wrinkle map is a model of the strain
    kWrinkleLayers = 1u << 8,       // the map has two layers, each with a strength of its own
    kWrinkleIndependent = 1u << 9,  // with kWrinkleLayers: the second one covers the first
    kWrinklePhoto = 1u << 10,       // light from above is painted on the wrinkles
    kWrinkleBounce = 1u << 11,      // light bounces within isometric folds
    kWrinkleShade = 1u << 12,       // lit slopes are darkened
};

extern const SurfaceHook kWrinkleHook;

/// The bits of skin with these wrinkles; where each column of the image has a method of its own,
/// those of `columns`.
[[nodiscard]] std::uint16_t wrinkle_features(const WrinkleSurface& surface, bool shades);
[[nodiscard]] std::uint16_t
column_features(const WrinkleSurface& surface, const std::vector<WrinkleMethod>& columns);

}  // namespace limn
