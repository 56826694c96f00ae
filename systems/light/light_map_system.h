#pragma once

#include "ecs/commands.h"
#include "ecs/components/light_map.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/mesh_bvh.h"

#include <cstdint>
#include <vector>

namespace limn {

// Light maps (light_map.h): what BakedLights give each texel is found when a level starts, and
// again where a light was or is that changes. Which texels a light reaches follows from the boxes
// of patches of 8 x 8 texels and its sphere of influence; no other texel is written.
// Reads LightMap, BakedLight, lights, WorldTransform; writes LightMapState, MeshInstance (a mesh
// with charts and a material with the map), and appends to Assets.
// Techniques: light.lightmap

/// Resource: all meshes with light maps, which shadow each other; never saved.
struct LightMapOccluders {
    std::uint64_t made_of = 0;  ///< hash of meshes and matrices
    MeshBvh bvh{};
};

using LightMapLights = Query<
    With<BakedLight>, const WorldTransform, Optional<const PointLight>, Optional<const SpotLight>,
    Optional<const DirectionalLight>>;

using LightMapMeshes =
    Query<const LightMap, LightMapState, const MeshInstance, const WorldTransform>;

void add_light_map_states(Query<const LightMap, Without<LightMapState>> maps, Commands commands);

/// After everything that moves lights. Meshes that move are lit anew.
void update_light_maps(
    LightMapMeshes maps, Query<MeshInstance> instances, LightMapLights lights, Res<Assets> assets,
    Res<LightMapOccluders> occluders);

// ---- parts of the above ----

[[nodiscard]] LightMapSource light_map_source(const PointLight& light, const Affine& world);
[[nodiscard]] LightMapSource light_map_source(const SpotLight& light, const Affine& world);
[[nodiscard]] LightMapSource light_map_source(const DirectionalLight& light, const Affine& world);

/// Irradiance / pi at a texel without shadow, as the renderer's lights have it.
[[nodiscard]] Vec3 light_at_texel(const LightMapSource& source, const LightMapTexel& texel);

/// Whether the source's sphere of influence meets the box. Light of color 0 meets none.
[[nodiscard]] bool reaches(const LightMapSource& source, const Bounds& box);

/// The lights of a map, by increasing entity.
struct PlacedSource {
    Entity entity;
    LightMapSource source;
};

/// Stores in `state`, and in the pixels of `image`, which must have the map's size and format, what
/// the sources now give: only at texels of patches that a source which has changed reached or
/// reaches. `occluders` may be null. Returns how many texels those are.
std::uint64_t update_light_map(
    LightMapState& state, LightMapFormat format, std::vector<PlacedSource> sources,
    const MeshBvh* occluders, ImageData& image);

/// A dark map.
[[nodiscard]] ImageData make_light_map_image(LightMapFormat format, int width, int height);

}  // namespace limn
