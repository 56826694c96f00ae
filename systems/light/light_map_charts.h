#pragma once

#include "ecs/components/light_map.h"
#include "ecs/components/surface.h"

#include <optional>
#include <span>
#include <vector>

namespace limn {

// The second set of texture coordinates of a mesh: charts, which do not overlap, and the texels in
// them.
// Techniques: light.lightmap

inline constexpr int kMaxLightMapSize = 2048;  ///< [texels]

/// A mesh whose uvs1 are those of an image of this size.
struct ChartedMesh {
    MeshData mesh;
    int width = 0;
    int height = 0;
};

/// Cuts a mesh into charts: connected triangles that face the same of six axes, seen along it. They
/// stretch by up to the root of 3, and lie two texels apart. Charts that overlap themselves, such
/// as spirals, do so in the image, too. `density`: texels per unit of length; it is halved until
/// the image has at most kMaxLightMapSize texels along a side. Vertices between charts become
/// several; the order of triangles stays. None for meshes without triangles of finite size.
[[nodiscard]] std::optional<ChartedMesh> cut_into_charts(const MeshData& mesh, float density);

/// The texels of an image of this size in the charts of `uvs1`, and those within one texel around
/// them, which take what is nearest: they are filtered with them. In mesh space.
[[nodiscard]] std::vector<LightMapTexel>
light_map_texels(const MeshData& mesh, int width, int height);

/// Sorts texels by blocks of 8 x 8 pixels of an image of this width, and lists the blocks.
[[nodiscard]] std::vector<LightMapPatch>
make_light_map_patches(std::vector<LightMapTexel>& texels, int width);

}  // namespace limn
