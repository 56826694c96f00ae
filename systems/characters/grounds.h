#pragma once

#include "ecs/components/foot_plant.h"
#include "ecs/components/height_field.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/param_group.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/animation/ik/placements.h"
#include "systems/characters/capsule.h"
#include "systems/particles/mesh_bvh.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace limn {

// What characters stand on and do not pass through: entities that are Walkable, as they are placed
// in this step.

/// Resource: hierarchies of the meshes that are Walkable, in their own spaces; never saved.
struct WalkableMeshes {
    struct Entry {
        MeshId mesh{};
        std::uint32_t version = 0;
        MeshBvh bvh{};
    };
    std::vector<Entry> entries{};
};

/// The hierarchy of a mesh, which must exist; built when it is new or was changed. Growing the list
/// invalidates earlier results.
[[nodiscard]] const MeshBvh*
find_walkable_mesh(const Assets& assets, MeshId id, WalkableMeshes& meshes);

/// The highest ground on a vertical line, in the ground's space.
struct GroundHit {
    float height = 0.0f;  ///< along y
    Vec3 normal = {0, 1, 0};
};

/// The height of a field at (x, z) of its space, bilinear; none outside.
[[nodiscard]] std::optional<GroundHit> find_height(const HeightField& field, float x, float z);

/// A Walkable entity: a mesh, a height field, or the plane y = 0 of its space.
struct PlacedGround {
    Entity entity{};
    Entity base{};  ///< its topmost parent, or itself
    Affine world{};
    Affine local{};  ///< local_from_world
    const MeshBvh* mesh = nullptr;
    const HeightField* field = nullptr;
};

/// The highest ground between both ends of a segment that points down.
struct Landing {
    const PlacedGround* ground = nullptr;  ///< null: none
    Vec3 point = {0, 0, 0};                ///< in the world
    Vec3 normal = {0, 1, 0};               ///< likewise, up
};

/// What a system needs to know of grounds.
struct GroundQueries {
    Query<const Walkable, Optional<const MeshInstance>, Optional<const HeightField>> grounds;
    Query<const Transform> transforms;
    Query<const Parent> parents;
    OptionalRes<const Assets> assets;
    OptionalRes<WalkableMeshes> meshes;
};

template <>
struct SystemParam<GroundQueries>
    : ParamGroup<
          GroundQueries,
          Query<const Walkable, Optional<const MeshInstance>, Optional<const HeightField>>,
          Query<const Transform>, Query<const Parent>, OptionalRes<const Assets>,
          OptionalRes<WalkableMeshes>> {};

/// All grounds, in world order; none without both resources. Builds the hierarchies of new meshes,
/// whose pointers are valid in this step. A ground whose matrix has no inverse is left out.
[[nodiscard]] std::vector<PlacedGround> place_grounds(const GroundQueries& queries);

[[nodiscard]] const PlacedGround* find_placed(std::span<const PlacedGround> grounds, Entity entity);

[[nodiscard]] Landing find_landing(std::span<const PlacedGround> grounds, const Segment& segment);

/// Fraction of a segment before it hits the mesh of a ground; 1: none.
[[nodiscard]] float
find_free_fraction(std::span<const PlacedGround> grounds, const Segment& segment);

/// The shortest horizontal way out of a closed mesh that contains a point: from inside, the first
/// triangles in four directions are seen from behind, within `reach` [m]. 0: it is in none.
[[nodiscard]] Vec3
find_way_out(std::span<const PlacedGround> grounds, const Vec3& point, float reach);

/// The deepest contact of a capsule with the triangles of meshes, and with what they belong to.
struct GroundContact {
    CapsuleContact contact{};
    Entity ground{};
};
[[nodiscard]] std::optional<GroundContact>
find_deepest_contact(std::span<const PlacedGround> grounds, const Capsule& capsule);

}  // namespace limn
