#pragma once

#include "ecs/base/math.h"
#include "ecs/components/light.h"
#include "ecs/components/surface.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Diffuse light that is stored in texels of meshes (light.lightmap). What a light map has cost when
// it was made is not paid again at each frame, for any number of lights; a light that changes is
// stored again where it reaches.
// Techniques: light.lightmap

/// Tag: the light of this entity is stored in the light maps of the meshes that it reaches, and
/// lights nothing else. Without highlights, pulse, cookie or shadow map.
struct BakedLight {};

/// What texels of light maps store.
enum class LightMapFormat : std::uint8_t {
    Floats,  ///< a sum per light: light that is removed leaves the others as they were
    Bytes,   ///< one sum for all, of 0 .. 1, as once was usual: what saturates is lost
};

/// With a MeshInstance: its mesh has a light map. A mesh with a second set of texture coordinates
/// is mapped by them: its charts must not overlap, and lie in 0 .. 1. Any other is cut into charts
/// along the axes of its space. Meshes with light maps shadow each other. Not for skinned or
/// morphed meshes.
struct LightMap {
    float density = 16.0f;
    bool shadows = true;
    LightMapFormat format = LightMapFormat::Floats;
};

LIMN_FIELDS(LightMap) {
    LIMN_FIELD(density, "texels along a meter", "1/m", 0.01, 1000);
    LIMN_FIELD(shadows, "meshes with light maps block the stored light");
    LIMN_FIELD(
        format, .doc = "what texels store: floats for each light, or bytes for their sum",
        .values = "floats bytes");
}

/// A texel in world space.
struct LightMapTexel {
    Vec3 position = Vec3(0);
    Vec3 normal = {0, 0, 1};  ///< unit
    std::uint32_t pixel = 0;  ///< in the image, row by row
};

/// Up to 64 texels that are near each other: what a light reaches is found by their boxes.
struct LightMapPatch {
    std::uint32_t first = 0;  ///< texel
    std::uint32_t count = 0;
    Bounds box;
};

/// All of a light that its texels depend on.
struct LightMapSource {
    Vec3 color = Vec3(0);  ///< times candela, or lux of directional lights
    Vec3 position = Vec3(0);
    Vec3 axis = {0, 0, -1};
    float radius = 0;  ///< 0: unbounded
    Attenuation attenuation = {};
    float inner_angle = kPi;  ///< kPi: light in all directions
    float outer_angle = kPi;
    SpotProfile profile = SpotProfile::Smoothstep;
    bool directional = false;
};

/// A light as it is stored.
struct LightMapLight {
    Entity entity;
    LightMapSource source;
    std::vector<Vec3> light;  ///< irradiance / pi of each texel
};

/// Internal state of update_light_maps.
struct LightMapState {
    MeshId mesh;          ///< as drawn: with charts
    MaterialId material;  ///< that draws the map
    ImageId image;
    MeshId refused;             ///< cannot have a light map
    std::uint64_t made_of = 0;  ///< hash of what the texels depend on
    std::vector<LightMapTexel> texels;
    std::vector<LightMapPatch> patches;
    std::vector<LightMapLight> lights;
    std::uint64_t updated_texels = 0;  ///< in all
};

/// Derived from meshes and lights.
template <>
struct ComponentTraits<LightMapState> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
