#pragma once

#include <cstdint>

namespace limn {

class Variant;

/// What the program of a surface must do. Each bit is a definition of lib/material.glsl, mesh.vert
/// and gbuffer.frag; their names are in surface_features.cpp.
enum SurfaceFeature : std::uint32_t {
    kBaseColorMap = 1u << 0,  // the five maps in the order of the texture units
    kMetalRoughMap = 1u << 1,
    kNormalMap = 1u << 2,
    kOcclusionMap = 1u << 3,
    kEmissionMap = 1u << 4,
    kUvMap = 1u << 5,
    kUvMaps = 1u << 6,
    kAlphaMask = 1u << 7,
    kDoubleSided = 1u << 8,
    kSrgbBaseColor = 1u << 9,
    kVertexColor = 1u << 11,      // added by the mesh
    kVelocity = 1u << 12,         // added by the view
    kOcclusionShared = 1u << 13,  // occlusion is the red channel of the metal-rough texture
    kInflate = 1u << 14,          // added by the instance
    kDeformed = 1u << 15,         // added by the instance: its vertices are its own (skinning/)
};

/// Adds the definition of each bit.
void add_features(Variant& variant, std::uint32_t features);

}  // namespace limn
