#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/force_field.h"
#include "ecs/components/height_field.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/param_group.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/ragdoll/ragdoll_rig.h"
#include "systems/characters/grounds.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/water/water_query.h"

#include <cstddef>
#include <vector>

namespace limn {

// Ragdolls: characters that physics moves instead of their animation (ragdoll_solver.h). They are
// stepped after everything else has moved, and posed in the next step. They float in water and
// meet each other (ragdoll_pairs.h); what else they bump into is not moved by them.

/// Resource: the capsules of skeletons; never saved.
struct RagdollRigs {
    struct Entry {
        SkeletonId skeleton{};
        std::size_t joints = 0;
        RagdollRig rig{};
    };
    std::vector<Entry> entries{};
};

/// What ragdolls collide with and are moved by, as one parameter.
struct RagdollSurroundings {
    Query<
        const ParticleCollider, const WorldTransform, const PreviousWorldTransform,
        Optional<const HeightField>, Optional<const Deformed>>
        colliders;
    Query<
        const Walkable, const WorldTransform, const PreviousWorldTransform,
        Optional<const MeshInstance>, Optional<const HeightField>, Without<ParticleCollider>>
        grounds;
    Query<const ForceField, const WorldTransform> fields;
    Query<const Parent> parents;
    WaterQuery waters;
    Res<const ParticleObstacles> obstacles;
    Res<WalkableMeshes> meshes;
};
template <>
struct SystemParam<RagdollSurroundings>
    : ParamGroup<
          RagdollSurroundings,
          Query<
              const ParticleCollider, const WorldTransform, const PreviousWorldTransform,
              Optional<const HeightField>, Optional<const Deformed>>,
          Query<
              const Walkable, const WorldTransform, const PreviousWorldTransform,
              Optional<const MeshInstance>, Optional<const HeightField>, Without<ParticleCollider>>,
          Query<const ForceField, const WorldTransform>, Query<const Parent>, WaterQuery,
          Res<const ParticleObstacles>, Res<WalkableMeshes>> {};

void add_ragdoll_states(
    Query<const Ragdoll, With<Skeleton>, Without<RagdollState>> bare, Commands commands);

/// Where the characters of ragdolls are in this step. Before update_poses.
void place_ragdolls(
    Query<RagdollState> ragdolls, Query<const Transform> transforms, Query<const Parent> parents);

/// A step of all ragdolls, of at most kMaxParticleStep. After find_particle_obstacles.
void update_ragdolls(
    Query<
        Ragdoll, RagdollState, const Skeleton, const Pose, const WorldTransform,
        const PreviousWorldTransform, Optional<const ClipPlayer>, Optional<const MorphWeights>>
        ragdolls,
    Query<Transform, With<Ragdoll>> transforms, RagdollSurroundings around,
    Res<const Assets> assets, Res<RagdollRigs> rigs, OptionalRes<const StepJumps> jumps,
    Res<const FrameTime> time, Commands commands);

}  // namespace limn
