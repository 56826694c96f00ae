#pragma once

#include "content/bake/bake_rows.h"
#include "content/bake/ray_caster.h"
#include "content/bake/relief_map.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

struct MeshData;

// Detail recovery (bump.nm-detail-recovery; Krishnamurthy and Levoy 1996, Cohen et al. 1998): maps
// that make a mesh with few triangles look like one with many.
//
// At each sample of a texel in the low mesh's chart, a line along the cage normal, both ways, meets
// the high mesh. Of the hits within the search distance that face the same way the nearest counts,
// else the nearest of all, else the nearest point of the high mesh. Cage normals are averaged over
// the vertices at a position, so that lines do not part at hard edges and seams.
//
// The normal of the high mesh is written in the frame that the renderer and MikkTSpace rebuild:
// interpolated N and T, not normalized, and B = w cross(N, T),
//
//     n_high ~ x T + y B + z N.
//
// Charts are dilated so that filtering stays within them.

struct DetailSettings {
    int width = 1024;
    int height = 1024;
    int samples = 2;               ///< samples per texel and direction, 1 .. 4
    float distance = 0.02f;        ///< search along the cage normal, of the low mesh's diagonal
    int padding = 8;               ///< texels around charts
    bool object_space = false;     ///< normals in mesh space
    int occlusion_rays = 0;        ///< per texel against the high mesh; 0: no occlusion map
    float occlusion_reach = 0.1f;  ///< of the low mesh's diagonal
};

struct DetailReport {
    std::size_t covered = 0;      ///< samples in charts
    std::size_t missed = 0;       ///< of those, where nothing was within the distance
    std::size_t from_point = 0;   ///< of those, where only the nearest point was
    std::size_t overlapping = 0;  ///< of those, in several triangles: the first counts
    std::size_t degenerate = 0;   ///< triangles without area in texture space
    std::size_t outside = 0;      ///< triangles that reach beyond the map
};

struct DetailBake {
    BakedMap normal;  ///< RGB; where the mesh has no chart, flat
    BakedMap height;  ///< R: distance of the high mesh along the cage normal, 0.5 at 0, 0 and 1 at
                      ///< the search distance
    BakedMap occlusion = {};  ///< R; empty without rays
    float distance = 0;       ///< that of the search [m]
    DetailReport report = {};
};

/// A relief map (relief.map-format) for the low mesh moved out along its cage normals.
struct DetailRelief {
    BakedMap map;      ///< RGB: the normal; A: depth, 0 on the moved mesh and 1 deepest
    float raised = 0;  ///< by which the mesh is moved out [m]
    float depth = 0;   ///< of the relief [m], > 0
};

/// `low` has uvs, normals and tangents for them. Fails where it has no chart.
[[nodiscard]] Result<DetailBake> bake_detail(
    const MeshData& low, const MeshData& high, const DetailSettings& settings,
    const RowProgress& progress = {});

/// The relief of a bake in tangent space: the mesh is moved out just so far that all of the high
/// mesh is below it.
[[nodiscard]] DetailRelief make_relief(const DetailBake& bake);

/// Moves the vertices of a mesh along their cage normals [m].
void move_out(MeshData& mesh, float distance);

/// (x, y, z) with n = x T + y w cross(N, T) + z N, of unit length; (0, 0, 1) for a degenerate
/// frame.
[[nodiscard]] Vec3 in_tangent_frame(const Vec3& n, const Vec3& normal, const Vec4& tangent);

/// Gives texels with `covered` = 0 near others the mean of those; `rings` texels wide.
void dilate(BakedMap& map, std::vector<std::uint8_t> covered, int rings);

}  // namespace limn
