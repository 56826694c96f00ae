#pragma once

#include "ecs/base/math.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace limn {

// Rays against the triangles of a mesh, through Embree. Embree finds which triangles a ray meets;
// where it meets them is computed here in double precision, and of triangles at the same distance
// the one with the lowest index counts. Results therefore do not depend on how the hierarchy was
// built or on the number of threads, and Embree runs with one instruction set (AVX, where the
// processor has it), so that they do not depend on the machine.
//
// Both sides of a triangle count. Rays do not pass between triangles that share an edge. Triangles
// without area and with positions that are not finite are never hit, and rays that are not finite
// hit nothing. Thread-safe once constructed.

/// origin + t direction for min_t <= t <= max_t, within rounding errors: start before a surface
/// that must be hit. The direction need not have unit length.
struct MeshRay {
    Vec3 origin = Vec3(0);
    Vec3 direction = {0, 0, -1};
    float min_t = 0;  ///< >= 0
    float max_t = std::numeric_limits<float>::infinity();
};

struct RayHit {
    float t = 0;
    std::uint32_t triangle = 0;
    Vec3 weights = {1, 0, 0};  ///< barycentric coordinates, each 0 .. 1, sum 1
    bool front = true;         ///< the ray comes from where the triangle is counter-clockwise
};

class RayCaster {
  public:
    /// Copies what it needs. `indices`: three per triangle, each below the number of positions.
    RayCaster(std::span<const Vec3> positions, std::span<const std::uint32_t> indices);
    RayCaster(RayCaster&& other) noexcept;
    RayCaster& operator=(RayCaster&& other) noexcept;
    ~RayCaster();

    /// The hit with the smallest t.
    [[nodiscard]] std::optional<RayHit> nearest(const MeshRay& ray) const;

    /// Replaces `hits` by all hits, by increasing t, at equal t by triangle. A ray through an edge
    /// hits both triangles at it.
    void find_all(const MeshRay& ray, std::vector<RayHit>& hits) const;

    /// The point of the triangles that is nearest to `point`, as a hit whose t is the distance;
    /// none within `max_distance`.
    [[nodiscard]] std::optional<RayHit> nearest_point(const Vec3& point, float max_distance) const;

    /// Bounds of the triangles.
    [[nodiscard]] const Bounds& bounds() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// A value per vertex, interpolated at a hit.
template <typename T>
[[nodiscard]] T
at_hit(const RayHit& hit, std::span<const std::uint32_t> indices, std::span<const T> values) {
    const std::size_t first = std::size_t{3} * hit.triangle;
    return hit.weights.x * values[indices[first]] + hit.weights.y * values[indices[first + 1]]
           + hit.weights.z * values[indices[first + 2]];
}

}  // namespace limn
