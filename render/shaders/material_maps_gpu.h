// The maps of a material. Each is a layer of a texture array that holds images of one size and format; maps in one
// array with one sampler share a texture unit, so that a material with many maps needs few units.

#ifdef __cplusplus
#pragma once
#include "render/shaders/lib/gpu_types.h"
namespace limn::layout {
#endif

// Slots, in the order of the rows of render/material/material_maps.cpp.
const uint kBaseColorSlot = 0u;
const uint kMetalRoughSlot = 1u;  // g: roughness, b: metalness, r: occlusion if OCCLUSION_SHARED
const uint kNormalSlot = 2u;      // tangent space, green up
const uint kOcclusionSlot = 3u;   // r
const uint kEmissionSlot = 4u;
const uint kWrinkleSlot = 5u;  // like normals; 128 of 255 is flat
const uint kDetailSlot = 6u;   // like normals
const uint kThicknessSlot = 7u;  // g
const uint kReliefSlot = 8u;   // rg: like normals, a: depth, b: see Material::relief_texture
const uint kClearcoatSlot = 9u;             // r
const uint kClearcoatRoughnessSlot = 10u;   // g
const uint kClearcoatNormalSlot = 11u;      // like normals
const uint kSheenSlot = 12u;
const uint kSheenRoughnessSlot = 13u;       // a
const uint kSpecularWeightSlot = 14u;       // a
const uint kSpecularTintSlot = 15u;
const uint kAnisotropySlot = 16u;           // rg: direction along tangent and bitangent, b: strength
const uint kIridescenceSlot = 17u;          // r
const uint kIridescenceThicknessSlot = 18u; // g
const uint kNormalSpreadSlot = 19u;         // of the normal map: render/material/normal_mips.h
const uint kTransmissionSlot = 20u;         // r
const uint kLightMapSlot = 21u;             // irradiance / pi

const uint kMaxMapSlots = 24u;

// Texture units of the maps.
const uint kFirstMapUnit = 0u;
const uint kMapUnits = 5u;

// MaterialRecord::maps: the layers of all slots, three to a float, as an integer that a float stores exactly.
const uint kLayerBits = 8u;
const uint kLayersPerFloat = 3u;
const uint kLayersPerTexel = 4u * kLayersPerFloat;
const uint kMapTexels = kMaxMapSlots / kLayersPerTexel;

// A material whose maps do not all use the first uv set untransformed has a kUvBlock: for slot s, texel 2 s = rows (u:
// xy, v: zw) of a 2x3 map, 2 s + 1 = offset xy, uv set z. If all maps share a uv map, it is in slot 0.

#ifdef __cplusplus
static_assert(kMaxMapSlots % kLayersPerTexel == 0);
}  // namespace limn::layout
#endif
