#pragma once

#include "render/material/material_maps.h"

#include <cstdint>

namespace limn {

class Variant;

/// What the program of a surface must do, beside reading its maps. Each bit is a definition of
/// lib/material.glsl, mesh.vert and gbuffer.frag; their names are in surface_features.cpp.
enum SurfaceFeature : std::uint32_t {
    kUvMap = 1u << 0,
    kUvMaps = 1u << 1,
    kAlphaMask = 1u << 2,
    kDoubleSided = 1u << 3,
    kSrgbBaseColor = 1u << 4,
    kOcclusionShared = 1u << 5,  // occlusion is the red channel of the metal-rough map
    kVertexColor = 1u << 6,      // added by the mesh
    kInflate = 1u << 7,          // added by the instance
    kDeformed = 1u << 8,         // added by the instance: its vertices are its own (skinning/)
    kVelocity = 1u << 9,         // added by the view
    kWrinkleBlend = 1u << 10,    // added by the instance, of wrinkles
    kWrinkleFade = 1u << 11,
    kWrinkleFlat = 1u << 12,
    kWrinkleView = 1u << 13,  // needs no wrinkle map
    kTransmission = 1u << 14,
    kRefraction = 1u << 15,          // with kTransmission: the medium has a thickness
    kStrands = 1u << 16,             // of hair
    kWrinkleDisplaced = 1u << 17,    // folds move its vertices
    kWrinkleColumns = 1u << 18,      // each column of the image has a method of its own
    kWrinkleModel = 1u << 19,        // the wrinkle map is a model of the strain
    kWrinkleLayers = 1u << 20,       // the map has two layers, each with a strength of its own
    kWrinkleIndependent = 1u << 21,  // with kWrinkleLayers: the second one covers the first
    kWrinklePhoto = 1u << 22,        // light from above is painted on the wrinkles
    kWrinkleBounce = 1u << 23,       // light bounces within isometric folds
};

struct SurfaceFeatures {
    std::uint32_t bits = 0;  ///< of SurfaceFeature
    MapUnits maps = {};

    [[nodiscard]] bool has(SurfaceFeature feature) const { return (bits & feature) != 0; }
    bool operator==(const SurfaceFeatures&) const = default;
};

/// Adds the definition of each bit and each map.
void add_features(Variant& variant, const SurfaceFeatures& features);

}  // namespace limn
