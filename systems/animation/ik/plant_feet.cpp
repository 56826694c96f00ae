#include "systems/animation/ik/plant_feet.h"

#include "ecs/base/rotation.h"
#include "systems/animation/ik/joint_tree.h"
#include "systems/animation/ik/pose_ik.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

constexpr float kMaxFootSlope = 0.6f;   // that feet turn to [rad]
constexpr float kSlopingHeight = 2.5f;  // of ankles at rest

}  // namespace

Quat foot_slope(const FootPlant& plant, const Vec3& normal) {
    const AxisAngle turn =
        axis_angle(rotation_between(Vec3(0, 1, 0), normalize_or(normal, Vec3(0, 1, 0))));
    const float weight = std::clamp(plant.weight, 0.0f, 1.0f);
    return rotation_about(turn.axis, std::min(turn.angle, kMaxFootSlope) * plant.align * weight);
}

float sloping_height(const SkeletonData& skeleton, std::uint16_t foot) {
    return kSlopingHeight * std::max(find_place(skeleton, skeleton.rest, foot).position.y, 0.0f);
}

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
        // It turns about the point of the ground below the ankle, which stays where it is.
        const Quat slope = foot_slope(plant, contacts.normals[i]);
        const Vec3& ankle = places[i].position;
        const float low = std::min(ankle.y, sloping_height(skeleton, feet[i]));
        const Vec3 target = Vec3(ankle.x, weight * contacts.lifts[i], ankle.z)
                            + Vec3(0, ankle.y - low, 0) + slope * Vec3(0, low, 0);
        const LimbReach reach = {.target = target, .options = {.softness = plant.softness}};
        reach_with_limb(skeleton, find_limb(skeleton, feet[i], 2), reach, pose);
        set_joint_rotation(skeleton, feet[i], slope * places[i].rotation, 1, pose);
    }
}

}  // namespace limn
