#pragma once

#include "render/geometry/instance_list.h"

#include <span>
#include <vector>

namespace limn {

class MeshPool;
struct LightRange;
struct LightList;

// Where bumps are lit (ShadingRate::BumpAuto): fine, regular meshes with vectors to lights at their
// vertices (ShadingRate::BumpVertex), coarse ones, such as floors and walls, per pixel. Where a
// fine mesh meets a coarse one, a seam may show.
// Techniques: bump.strategy

/// Longest edge that vectors to a light at unit distance are interpolated over.
inline constexpr float kCoarseEdge = 0.25f;

enum class BumpStrategy : std::uint8_t { Vertex, Pixel };

/// Both in meters; the distance may be infinite.
[[nodiscard]] BumpStrategy bump_strategy(float mean_edge, float light_distance);

/// From the box of an object to the nearest lamp that reaches it; INFINITY if none does.
[[nodiscard]] float
nearest_lamp(std::span<const LightRange> lamps, const Vec3& center, const Vec3& half);

/// The draws of a list by the strategy of their nearest object. Only those of Blinn and Phong
/// surfaces with normal maps can be lit at vertices.
struct BumpRuns {
    std::vector<DrawRun> vertex;
    std::vector<DrawRun> pixel;
};
[[nodiscard]] BumpRuns
split_bump_runs(const InstanceList& list, const MeshPool& meshes, const LightList& lights);

}  // namespace limn
