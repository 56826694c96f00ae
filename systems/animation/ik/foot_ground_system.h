#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/height_field.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/particles/mesh_bvh.h"

#include <optional>
#include <vector>

namespace limn {

// What the feet of characters stand on. A contact is a point in the space of its ground, which
// carries it: on a deck that heaves, feet go with it, and only where a foot passes over other
// ground does it follow with a delay.

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

void add_foot_contacts(
    Query<const FootPlant, With<Skeleton>, Without<FootContacts>> bare, Commands commands);

/// After everything that moves grounds and characters; before update_poses. Feet are looked for
/// where they were in the last step.
void update_foot_contacts(
    Query<const Skeleton, const FootPlant, const Pose, FootContacts> characters,
    Query<const Walkable, Optional<const MeshInstance>, Optional<const HeightField>> grounds,
    Query<const Transform> transforms, Query<const Parent> parents, Res<const Assets> assets,
    Res<WalkableMeshes> meshes, OptionalRes<const FrameTime> time);

}  // namespace limn
