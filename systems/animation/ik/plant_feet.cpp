#include "systems/animation/ik/plant_feet.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/pose_ik.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

constexpr float kMaxFootSlope = 0.6f;  // that feet turn to [rad]

}  // namespace

void apply_foot_plant(
    const SkeletonData& skeleton, const FootPlant& plant, const FootContacts& contacts,
    LocalPose& pose) {
    const float weight = std::clamp(plant.weight, 0.0f, 1.0f);
    const auto& feet = contacts.feet;
    if (!(weight > 0) || feet[0] >= pose.size() || feet[1] >= pose.size()) {
        return;
    }
    // Where the feet would be, before the root moves.
    JointPlace places[2];
    for (std::size_t i = 0; i < 2; ++i) {
        places[i] = find_place(skeleton, pose, feet[i]);
    }
    pose.translations[0].y += weight * std::min(contacts.lifts[0], contacts.lifts[1]);
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 target = places[i].position + Vec3(0, weight * contacts.lifts[i], 0);
        const LimbReach reach = {.target = target, .options = {.softness = plant.softness}};
        reach_with_limb(skeleton, find_limb(skeleton, feet[i], 2), reach, pose);
        const Vec3 normal = normalize_or(contacts.normals[i], Vec3(0, 1, 0));
        const Quat slope = rotation_between(Vec3(0, 1, 0), normal);
        const AxisAngle turn = axis_angle(slope);
        const float angle = std::min(turn.angle, kMaxFootSlope) * plant.align * weight;
        set_joint_rotation(
            skeleton, feet[i], rotation_about(turn.axis, angle) * places[i].rotation, 1, pose);
    }
}

}  // namespace limn
