#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/height_field.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "systems/particles/particle_collision.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace limn {

/// The triangles of a ParticleCollider in world space. While only its vertices move, the hierarchy
/// is refitted.
struct ObstacleMesh {
    Entity entity{};
    MeshId mesh{};
    std::uint32_t version = 0;  ///< of the mesh
    Affine world{};
    bool deforms = false;
    std::uint64_t frame = 0;        ///< in which it last existed
    std::vector<Vec3> positions{};  ///< [m]
    MeshBvh bvh{};
};

/// Resource: the solid ParticleColliders of a level in this step.
struct ParticleObstacles {
    ColliderSet solid{};                 ///< points to `meshes`
    std::vector<ObstacleMesh> meshes{};  ///< kept from step to step
    std::uint64_t frame = 0;             ///< counts the steps
};

/// The shape of a solid collider in the world; none for a mesh, water, or a height field that is
/// turned or scaled.
[[nodiscard]] std::optional<Collider>
find_solid_shape(const ParticleCollider& collider, const Affine& world, const HeightField* field);

/// Finds them all. After everything that moves or deforms them; before update_particles.
void find_particle_obstacles(
    Query<
        const ParticleCollider, const WorldTransform, Optional<const MeshInstance>,
        Optional<const Deformed>, Optional<const DeformerState>,
        Optional<const SurfaceBindingState>, Optional<const HeightField>>
        colliders,
    Query<const Pose> poses, Query<const MorphWeights> morphs, Res<const Assets> assets,
    Res<ParticleObstacles> obstacles);

}  // namespace limn
