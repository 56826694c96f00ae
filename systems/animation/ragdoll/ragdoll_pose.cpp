#include "systems/animation/ragdoll/ragdoll_pose.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ragdoll/crouch.h"

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <vector>

// Techniques: char.dynamics

namespace limn {
namespace {

constexpr float kCrouchTime =
    0.45f;  // what is left of the time to get up when the feet carry the body

float smooth_step(float x) {
    const float u = std::clamp(x, 0.0f, 1.0f);
    return u * u * (3 - 2 * u);
}

Quat rotation_part(const Affine& a) {
    Mat3 axes;
    for (int i = 0; i < 3; ++i) {
        axes[i] = {a.row[0][i], a.row[1][i], a.row[2][i]};
    }
    return extract_rotation(axes).value_or(Quat(1, 0, 0, 0));
}

/// Local translation of the first bone that brings its joint to where physics has it.
Vec3 root_translation(
    const SkeletonData& skeleton, const RagdollState& state, std::uint16_t joint,
    const LocalPose& pose) {
    const Vec3 world = state.positions[0] - state.rotations[0] * state.centers[0];
    const Vec3 target = transform_point(state.character_from_world, world);
    const JointPlace parent = find_place(skeleton, pose, skeleton.parents[joint]);
    const Vec3 local = glm::conjugate(parent.rotation) * (target - parent.position);
    const bool is_flat = parent.scale.x * parent.scale.y * parent.scale.z == 0;
    return is_flat ? pose.translations[joint] : local / parent.scale;
}

}  // namespace

void apply_ragdoll(const SkeletonData& skeleton, const RagdollState& state, LocalPose& pose) {
    const std::size_t bones = state.joints.size();
    const float left = std::clamp(finite_or(state.weight, 0), 0.0f, 1.0f);
    if (!(left > 0) || bones == 0 || state.positions.size() != bones
        || state.rotations.size() != bones || state.centers.size() != bones
        || state.joints.back() >= pose.size()) {
        return;
    }
    // Up again: into a crouch first, then from the feet.
    if (left < 1) {
        crouch(skeleton, smooth_step(left / kCrouchTime), pose);
    }
    const float weight = smooth_step((left - kCrouchTime) / (1 - kCrouchTime));
    thread_local std::vector<Quat> turns;  // of the joints in the character's space, by physics
    turns.resize(pose.size());
    const Quat to_character = rotation_part(state.character_from_world);
    std::size_t bone = 0;
    for (std::size_t j = 0; j < pose.size(); ++j) {
        const std::int32_t parent = skeleton.parents[j];
        const Quat above = parent < 0 ? Quat(1, 0, 0, 0) : turns[static_cast<std::size_t>(parent)];
        if (bone >= bones || state.joints[bone] != j) {
            turns[j] = above * pose.rotations[j];
            if (bone > 0) {
                pose.translations[j] =
                    glm::mix(pose.translations[j], skeleton.rest.translations[j], weight);
            }
            continue;
        }
        turns[j] = to_character * state.rotations[bone];
        const Vec3 place = bone == 0 ? root_translation(skeleton, state, state.joints[0], pose)
                                     : skeleton.rest.translations[j];
        pose.translations[j] = glm::mix(pose.translations[j], place, weight);
        const Quat local = normalize_or_identity(glm::conjugate(above) * turns[j]);
        pose.rotations[j] = slerp(pose.rotations[j], local, weight);
        ++bone;
    }
}

}  // namespace limn
