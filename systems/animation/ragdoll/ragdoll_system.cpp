#include "systems/animation/ragdoll/ragdoll_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "systems/animation/ik/placements.h"
#include "systems/animation/ragdoll/ragdoll_stepper.h"
#include "systems/particles/particle_motion.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: char.dynamics

namespace limn {
namespace {

void set_motion(
    RagdollObstacle& obstacle, const Affine& world, const Affine& previous, RagdollStage& stage) {
    Affine back;
    bool is_same = true;
    for (int i = 0; i < 3; ++i) {
        is_same = is_same && world.row[i] == previous.row[i];
    }
    if (is_same || previous.row[0] == Vec4(0) || !find_inverse(world, back)) {
        return;
    }
    obstacle.earlier_from_now = previous * back;
    obstacle.moves = true;
    stage.any_moves = true;
}

void add_obstacle(
    const Collider& shape, const Affine& world, const Affine& previous, Entity owner,
    RagdollStage& stage) {
    RagdollObstacle obstacle = {.shape = shape};
    if (!std::holds_alternative<MeshCollider>(shape)) {
        obstacle.bounds = find_collider_bounds(shape);
    }
    set_motion(obstacle, world, previous, stage);
    stage.obstacles.push_back(obstacle);
    stage.owners.push_back(owner);
}

void add_collider_obstacles(const RagdollSurroundings& around, RagdollStage& stage) {
    around.colliders.each([&](Entity entity, const ParticleCollider& collider,
                              const WorldTransform& transform,
                              const PreviousWorldTransform& previous, const HeightField* field,
                              const Deformed* deformed) {
        const Entity owner = deformed != nullptr ? deformed->character : entity;
        if (const auto shape = find_solid_shape(collider, transform.world, field)) {
            add_obstacle(*shape, transform.world, previous.world, owner, stage);
        }
        if (collider.shape == ColliderShape::Mesh) {
            for (const ObstacleMesh& mesh : around.obstacles->meshes) {
                if (mesh.entity == entity) {  // in the world
                    add_obstacle(
                        MeshCollider{&mesh.bvh}, transform.world, previous.world, owner, stage);
                }
            }
        }
    });
}

void add_ground_obstacles(
    const RagdollSurroundings& around, const Assets& assets, RagdollStage& stage) {
    const auto has_mesh = [&](const MeshInstance* instance, const HeightField* field) {
        return field == nullptr && instance != nullptr
               && instance->mesh.index < assets.meshes.size();
    };
    // All hierarchies first: pointers into the list are taken when it no longer grows.
    around.grounds.each([&](Entity, const Walkable&, const WorldTransform&,
                            const PreviousWorldTransform&, const MeshInstance* instance,
                            const HeightField* field) {
        if (has_mesh(instance, field)) {
            (void)find_walkable_mesh(assets, instance->mesh, *around.meshes);
        }
    });
    around.grounds.each([&](Entity entity, const Walkable&, const WorldTransform& transform,
                            const PreviousWorldTransform& previous, const MeshInstance* instance,
                            const HeightField* field) {
        if (has_mesh(instance, field)) {
            RagdollObstacle obstacle = {.world = transform.world};
            obstacle.shape =
                MeshCollider{find_walkable_mesh(assets, instance->mesh, *around.meshes)};
            if (find_inverse(obstacle.world, obstacle.local)) {
                set_motion(obstacle, transform.world, previous.world, stage);
                stage.obstacles.push_back(obstacle);
                stage.owners.push_back(entity);
            }
            return;
        }
        const ParticleCollider shape = {
            .shape = field != nullptr ? ColliderShape::HeightField : ColliderShape::Plane};
        if (const auto solid = find_solid_shape(shape, transform.world, field)) {
            add_obstacle(*solid, transform.world, previous.world, entity, stage);
        }
    });
}

const RagdollRig& find_rig(const Assets& assets, SkeletonId id, RagdollRigs& rigs) {
    const SkeletonData& skeleton = assets.skeletons[id.index];
    const auto found = std::find_if(
        rigs.entries.begin(), rigs.entries.end(),
        [id](const RagdollRigs::Entry& entry) { return entry.skeleton == id; });
    const bool is_new = found == rigs.entries.end();
    RagdollRigs::Entry& entry = is_new ? rigs.entries.emplace_back() : *found;
    if (is_new || entry.joints != skeleton.joints.size()) {
        entry = {id, skeleton.joints.size(), make_ragdoll_rig(skeleton)};
    }
    return entry.rig;
}

/// Where the character stands when it gets up: at its hips, on what is below it, facing away from
/// where its head lies if it lies on its back, else that way.
void move_to_body(
    const RagdollRig& rig, const RagdollState& state, float scale, float thickness,
    Transform& transform) {
    if (state.positions.empty() || rig.bones.size() != state.positions.size()) {
        return;
    }
    float lowest = INFINITY;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
        const RagdollBone& bone = rig.bones[i];
        const float half = 0.5f * scale * glm::distance(bone.from, bone.to);
        const Vec3 along = state.rotations[i] * normalize_or(bone.to - bone.from, Vec3(0, 1, 0));
        lowest = std::min(
            lowest,
            state.positions[i].y - half * std::abs(along.y) - bone.radius * scale * thickness);
    }
    const Quat turn = state.rotations[0] * glm::conjugate(rig.bones[0].rest);
    const Vec3 up = turn * Vec3(0, 1, 0);
    const Vec3 forward = turn * Vec3(0, 0, 1);
    Vec3 facing = forward;
    if (std::abs(up.y) < 0.7f) {
        facing = forward.y > 0 ? -up : up;
    }
    transform.position = {state.positions[0].x, lowest, state.positions[0].z};
    transform.rotation = rotation_about(Vec3(0, 1, 0), std::atan2(facing.x, facing.z));
}

}  // namespace

void add_ragdoll_states(
    Query<const Ragdoll, With<Skeleton>, Without<RagdollState>> bare, Commands commands) {
    bare.each([&](Entity entity, const Ragdoll&) { commands.add(entity, RagdollState{}); });
}

void place_ragdolls(
    Query<RagdollState> ragdolls, Query<const Transform> transforms, Query<const Parent> parents) {
    const Placements placements(transforms, parents);
    ragdolls.each([&](Entity entity, RagdollState& state) {
        Affine local;
        if (state.weight > 0 && find_inverse(placements.world(entity), local)) {
            state.character_from_world = local;
        }
    });
}

void update_ragdolls(
    Query<
        Ragdoll, RagdollState, const Skeleton, const Pose, const WorldTransform,
        const PreviousWorldTransform, Optional<const ClipPlayer>, Optional<const MorphWeights>>
        ragdolls,
    Query<Transform, With<Ragdoll>> transforms, RagdollSurroundings around,
    Res<const Assets> assets, Res<RagdollRigs> rigs, OptionalRes<const StepJumps> jumps,
    Res<const FrameTime> time, Commands commands) {
    if (ragdolls.empty()) {
        return;
    }
    RagdollStage stage;
    stage.dt = std::clamp(
        static_cast<double>(finite_or(time->step, 0)), 0.0, static_cast<double>(kMaxParticleStep));
    stage.assets = &*assets;
    stage.jumps = jumps.get();
    if (!(stage.dt > 0)) {
        return;
    }
    add_collider_obstacles(around, stage);
    add_ground_obstacles(around, *assets, stage);
    stage.forces = find_forces(around.fields, time->time);
    stage.waters = collect_water_surfaces(around.waters);
    // All rigs first: pointers into the list are taken when it no longer grows.
    ragdolls.each([&](Entity, Ragdoll&, RagdollState&, const Skeleton& skeleton, const Pose&,
                      const WorldTransform&, const PreviousWorldTransform&, const ClipPlayer*,
                      const MorphWeights*) {
        if (skeleton.skeleton.index < assets->skeletons.size()) {
            find_rig(*assets, skeleton.skeleton, *rigs);
        }
    });
    std::vector<RagdollCharacter> characters;
    ragdolls.each([&](Entity entity, Ragdoll& ragdoll, RagdollState& state,
                      const Skeleton& skeleton, const Pose& pose, const WorldTransform& world,
                      const PreviousWorldTransform& previous, const ClipPlayer* player,
                      const MorphWeights* morph) {
        if (skeleton.skeleton.index >= assets->skeletons.size()) {
            return;
        }
        const SkeletonData& data = assets->skeletons[skeleton.skeleton.index];
        const RagdollRig& rig = find_rig(*assets, skeleton.skeleton, *rigs);
        if (rig.bones.empty() || pose.joints.size() != data.joints.size()) {
            return;
        }
        characters.push_back(
            {entity, &ragdoll, &state, &data, &rig, &pose, world.world, previous.world, player,
             morph});
    });
    // What they meet is where it was before any of them moves.
    std::vector<RagdollBodies> placed(characters.size());
    std::vector<RagdollOutcome> outcomes(characters.size());
    parallel_for(characters.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            placed[i] = bound_ragdoll(find_meeting_bodies(characters[i]), stage.dt);
        }
    });
    const auto neighbors = find_ragdoll_neighbors(placed);
    parallel_for(characters.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::vector<PartingPlane> planes;
            for (const std::size_t k : neighbors[i]) {
                find_parting_planes(placed[i].bodies, placed[k].bodies, stage.dt, planes);
            }
            outcomes[i] = step_ragdoll_character(stage, characters[i], std::move(planes));
        }
    });
    const std::vector<RigidVec> changes = balance_momentum(outcomes, neighbors);
    for (std::size_t i = 0; i < characters.size(); ++i) {
        const RagdollCharacter& one = characters[i];
        if (changes[i] != RigidVec(0)) {
            for (Vec3& velocity : one.state->velocities) {
                velocity = Vec3(RigidVec(velocity) + changes[i]);
            }
        }
        const Entity entity = one.entity;
        Transform* const place = outcomes[i].gets_up ? transforms.find<Transform>(entity) : nullptr;
        if (place != nullptr && around.parents.find<const Parent>(entity) == nullptr) {
            move_to_body(
                *one.rig, *one.state, matrix_scale(one.world), find_thickness(*one.ragdoll),
                *place);
            commands.add(entity, Teleport{});
            commands.add(entity, PoseCut{});
        }
    }
}

}  // namespace limn
