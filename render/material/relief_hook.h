#pragma once

#include "ecs/components/surface.h"
#include "render/material/surface_hooks.h"

#include <cstdint>

namespace limn {

namespace gpu {
struct DeviceCaps;
}
enum class SurfaceDetail : std::uint8_t;

// What the relief of a material (Material::detail) adds to the programs of surfaces.
// lib/relief_surface.glsl explains the definitions.

/// Bits of kReliefHook.
enum ReliefFeature : std::uint16_t {
    kReliefFlat = 1u << 0,  // no maps of normals
    kReliefBump = 1u << 1,
    kReliefParallax = 1u << 2,
    kReliefLinear = 1u << 3,
    kReliefCones = 1u << 4,
    kReliefClosed = 1u << 5,
    kReliefCurved = 1u << 6,
    kReliefShifted = 1u << 7,  // maps are read at shifted texture coordinates
    kReliefOffMesh = 1u << 8,  // fragments lie below the mesh
    kReliefObject = 1u << 9,   // the normal map is in mesh space
    kReliefRays = 1u << 10,    // key lights are shadowed by a second ray (key_shadows.glsl)
    kReliefBottom = 1u << 11,  // casts shadows as its bottom, so that none falls on itself
    kReliefBoxed = 1u << 12,   // in a ReliefBox, which ends at its sides
    kReliefSliced = 1u << 13,  // with kReliefBoxed: fragments are in the box, on planes
    kReliefDisplaced = 1u << 14,
    kReliefOdd = 1u << 15,
};

extern const SurfaceHook kReliefHook;

/// Depth of the relief below the mesh [m]; 0: fragments are on the mesh.
[[nodiscard]] float depth_below_mesh(const Material& material);

/// `detail`, or the next one that the device can draw.
[[nodiscard]] SurfaceDetail supported_detail(SurfaceDetail detail, const gpu::DeviceCaps& caps);

/// Whether meshes with these features are tessellated, and their vertices displaced.
[[nodiscard]] bool is_tessellated(const SurfaceFeatures& features);

}  // namespace limn
