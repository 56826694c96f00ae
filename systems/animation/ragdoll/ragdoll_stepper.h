#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/step_jumps.h"
#include "ecs/entity.h"
#include "systems/animation/ragdoll/ragdoll_contacts.h"
#include "systems/animation/ragdoll/ragdoll_pairs.h"
#include "systems/animation/ragdoll/ragdoll_rig.h"
#include "systems/particles/force_fields.h"
#include "systems/water/water_query.h"

#include <vector>

namespace limn {

// One step of one ragdoll: from its animation or its state of the step before to its state.
//
// At the switch its muscles hold the animation, for `collapse`. Then, for six times as long, they
// turn joints weakly toward the middle of their limits, as people do whom a fall surprises: knees
// and hips give way, arms go ahead. With a collapse of 0 it is limp at once.

/// All that is the same for all ragdolls of a step.
struct RagdollStage {
    std::vector<RagdollObstacle> obstacles;
    std::vector<Entity> owners;  ///< of the obstacles: characters do not touch their own skin
    std::vector<Force> forces;
    std::vector<WaterSurface> waters;
    bool any_moves = false;
    double dt = 0;
    const Assets* assets = nullptr;
    const StepJumps* jumps = nullptr;
};

/// One of them.
struct RagdollCharacter {
    Entity entity{};
    Ragdoll* ragdoll = nullptr;
    RagdollState* state = nullptr;
    const SkeletonData* skeleton = nullptr;
    const RagdollRig* rig = nullptr;
    const Pose* pose = nullptr;
    Affine world{};
    Affine previous{};
    const ClipPlayer* player = nullptr;
    const MorphWeights* morph = nullptr;
};

/// A step, of `planes` between it and other ragdolls too.
RagdollOutcome step_ragdoll_character(
    const RagdollStage& stage, const RagdollCharacter& character, std::vector<PartingPlane> planes);

/// The capsules of an active ragdoll that meets others, where its state has them; else none.
[[nodiscard]] std::vector<RigidCapsule> find_meeting_bodies(const RagdollCharacter& character);

/// Mean factor of a matrix on lengths; 1 if it has none.
[[nodiscard]] float matrix_scale(const Affine& a);

/// Of a ragdoll, within its range.
[[nodiscard]] float find_thickness(const Ragdoll& ragdoll);

}  // namespace limn
