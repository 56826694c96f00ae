#pragma once

#include "systems/animation/ragdoll/ragdoll_pairs.h"
#include "systems/animation/ragdoll/ragdoll_solver.h"
#include "systems/particles/collider.h"
#include "systems/particles/collider_bounds.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Where the capsules of a body touch what is around them, and each other. Planes, spheres, boxes
// and height fields are solid; triangles are sheets with two sides, of which a capsule stays on the
// one where it is at the beginning of a step.

/// Something solid in this step.
struct RagdollObstacle {
    Collider shape = PlaneCollider{};  ///< in the world; a mesh: in the space of `world`
    ColliderBounds bounds{};           ///< of any but a mesh
    Affine world{};                    ///< of a mesh
    Affine local{};                    ///< local_from_world
    Affine earlier_from_now{};         ///< where a point of it was a step ago
    bool moves = false;

    [[nodiscard]] RigidVec velocity(const RigidVec& point, double dt) const;
};

/// Finds the contacts of one ragdoll during a step.
class RagdollContacts {
  public:
    /// Collects what may touch within dt [s]. `apart`: pairs of bodies as in RagdollRig; `planes`:
    /// between it and other ragdolls. The spans must outlive this.
    RagdollContacts(
        std::span<const RagdollObstacle> obstacles, std::span<const std::uint64_t> apart,
        const std::vector<RigidCapsule>& bodies, double dt, std::vector<PartingPlane> planes = {});

    /// Those when `left` [s] of the step are left. `margin`: also surfaces that near [m].
    void find(
        const std::vector<RigidCapsule>& bodies, double left, std::vector<RagdollContact>& contacts,
        double margin = 0) const;

  private:
    struct Near {
        std::size_t body;
        std::size_t obstacle;
        Triangle3 triangle;  ///< in the world, of a mesh
        double side;         ///< of the triangle: 1 or -1
    };
    struct NearBodies {
        std::size_t first;
        std::size_t second;
    };
    void collect_triangles(
        const RagdollObstacle& obstacle, std::size_t index, std::size_t body,
        const LineSegment& segment, double reach);

    std::span<const RagdollObstacle> obstacles_;
    double dt_;
    std::vector<Near> near_{};
    std::vector<NearBodies> pairs_{};
    std::vector<PartingPlane> planes_;
};

}  // namespace limn
