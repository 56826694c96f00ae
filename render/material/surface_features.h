#pragma once

#include "render/material/material_maps.h"
#include "render/material/surface_hooks.h"

#include <cstdint>

namespace limn {

class Variant;

/// What the program of a surface may need besides reading its maps; additions of single effects are
/// hooks (surface_hooks.h). Each bit is a definition of lib/material.glsl, mesh.vert and
/// gbuffer.frag; their names are in surface_features.cpp.
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
    kTransmission = 1u << 10,
    kRefraction = 1u << 11,   // with kTransmission: the medium has a thickness
    kStrands = 1u << 12,      // of hair and other strands
    kLayered = 1u << 13,      // material_layers.h
    kAnisotropic = 1u << 14,  // with kLayered
    kDispersion = 1u << 15,   // with kRefraction
    kLeanNormals = 1u << 16,  // with kAnisotropic: as the normal map's bumps are
    kBumpGate = 1u << 17,     // BumpShadow
    kBumpSmooth = 1u << 18,
    kBumpRamp = 1u << 19,
    kClassicBumps = 1u << 20,  // of Blinn and Phong, with a normal map (bump_strategy.h)
    kDressed = 1u << 21,       // of persons whose vertex colors have parts (Dress)
};

struct SurfaceFeatures {
    std::uint32_t bits = 0;  ///< of SurfaceFeature
    HookBits hooks = {};
    MapUnits maps = {};

    [[nodiscard]] bool has(SurfaceFeature feature) const { return (bits & feature) != 0; }
    bool operator==(const SurfaceFeatures&) const = default;
};

/// Adds the definition of each bit, also of hooks, and each map.
void add_features(Variant& variant, const SurfaceFeatures& features);

}  // namespace limn
