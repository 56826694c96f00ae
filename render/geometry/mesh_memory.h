#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "render/geometry/coarse_triangles.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace limn {

/// What is computed once of a new mesh, before it is uploaded.
struct PreparedMesh {
    std::vector<std::uint32_t> ordered;   ///< its triangles in the order of order_for_cache()
    std::vector<CoarseTriangles> coarse;  ///< of simplify_triangles()
    std::vector<Vec2> curvatures;         ///< of fit_curvatures(); empty until they are asked for
};

/// Prepares new meshes, all at once on all threads, and keeps the results for worlds that are
/// loaded again.
class MeshMemory {
  public:
    /// Of each mesh that is not null, whose indices must be in range; null for the others. Valid
    /// until the next call. `curved`: with curvatures.
    [[nodiscard]] std::vector<const PreparedMesh*>
    prepare(std::span<const MeshData* const> meshes, bool curved);

  private:
    static constexpr std::size_t kMaxBytes = std::size_t{128} << 20;  // then the cache is cleared
    std::map<std::uint64_t, PreparedMesh> prepared_;  // by a hash of all that is read of a mesh
    std::size_t bytes_ = 0;
};

}  // namespace limn
