#pragma once

#include "content/bake/height_map.h"
#include "content/bake/ray_caster.h"
#include "ecs/base/math.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace limn {

struct MeshData;

// A relief as triangles over a tile of the plane, to cast rays at: x to the right and y up the
// image, z toward the viewer, 0 on the polygon. The tile is 1 wide. The map's first row is at its
// top.

struct TileSurface {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;           ///< unit
    std::vector<std::uint32_t> indices;  ///< three per triangle
    Vec2 low = {0, 0};                   ///< lower left corner of the tile
    Vec2 size = {1, 1};                  ///< of the tile
    float depth = 1;                     ///< of the relief: z = -depth is deepest
    float meters = 1;                    ///< length of a unit of a mesh [m]
    bool repeats = false;                ///< the tile in both directions
};

/// Two triangles per square of four texel centers.
[[nodiscard]] TileSurface tile_of(const HeightMap& map, float depth);

/// The side of a box that becomes the polygon of a relief, by the direction that it faces.
enum class BoxFace : std::uint8_t { Right, Left, Top, Bottom, Front, Back };

/// The mesh as seen through the side `face` of its bounding box, which becomes the tile: images are
/// upright for a viewer who looks at it, with +y up, or -z up for Top and +z for Bottom. `depth`:
/// of the relief [m]; 0: of the box. `repeats`: tiles side by side. Normals that are missing are
/// those of the triangles.
[[nodiscard]] TileSurface tile_of(const MeshData& mesh, BoxFace face, float depth, bool repeats);

/// Rays against a tile and, where it repeats, against all its copies.
class TileCaster {
  public:
    explicit TileCaster(const TileSurface& tile);

    /// The nearest hit. Where the tile repeats, the ray must not run within the relief forever: it
    /// leaves through z = 0 or -depth, or `max_t` is finite.
    [[nodiscard]] std::optional<RayHit> nearest(const MeshRay& ray) const;
    [[nodiscard]] const RayCaster& single() const { return caster_; }

  private:
    RayCaster caster_;
    Vec2 low_;
    Vec2 size_;
    Bounds box_;
    bool repeats_ = false;
};

/// The unit normal of the surface at a hit, from vertex to vertex.
[[nodiscard]] Vec3 normal_at(const TileSurface& tile, const RayHit& hit);

}  // namespace limn
