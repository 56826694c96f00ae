#pragma once

#include <cstdint>

namespace limn {

/// What the program of a surface must do for how its wrinkles are drawn, beside the bits of
/// SurfaceFeature, whose last bits these are: definitions of lib/material.glsl. Added by the
/// instance.
enum WrinkleFeature : std::uint32_t {
    kWrinkleDisplaced = 1u << 26,    // folds move its vertices
    kWrinkleColumns = 1u << 27,      // each column of the image has a method of its own
    kWrinkleModel = 1u << 28,        // its wrinkle map is a model of the strain
    kWrinkleLayers = 1u << 29,       // the map has two layers, each with a strength of its own
    kWrinkleIndependent = 1u << 30,  // with kWrinkleLayers: the second one covers the first
    kWrinklePhoto = 1u << 31,        // light from above is painted on the wrinkles
};

}  // namespace limn
