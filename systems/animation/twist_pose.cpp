#include "systems/animation/twist_pose.h"

#include "ecs/base/rotation.h"
#include "ecs/components/humanoid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string>

namespace limn {
namespace {

constexpr float kShortestBone = 1e-6f;  ///< [m]

std::size_t find_skeleton_joint(const SkeletonData& skeleton, const std::string& name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    return static_cast<std::size_t>(found - skeleton.joints.begin());
}

bool is_called_twist(const std::string& name) {
    std::string lower = name;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return lower.find("twist") != std::string::npos;
}

/// Where a joint is along the bone to its sibling `end`: 0 .. 1.
float place_on_bone(const SkeletonData& skeleton, std::size_t joint, std::size_t end) {
    const Vec3& bone = skeleton.rest.translations[end];
    const float length2 = glm::dot(bone, bone);
    return length2 > 0
               ? std::clamp(glm::dot(skeleton.rest.translations[joint], bone) / length2, 0.0f, 1.0f)
               : 0.0f;
}

/// A bone of a limb. `own`: its skin turns with the joint itself, else with the one at its end.
struct LimbBone {
    BodyPart begin;
    BodyPart end;
    bool own;
};
constexpr std::array<LimbBone, 8> kLimbBones = {{
    {BodyPart::LeftUpperArm, BodyPart::LeftForearm, true},
    {BodyPart::LeftForearm, BodyPart::LeftHand, false},
    {BodyPart::LeftThigh, BodyPart::LeftShin, true},
    {BodyPart::LeftShin, BodyPart::LeftFoot, false},
    {BodyPart::RightUpperArm, BodyPart::RightForearm, true},
    {BodyPart::RightForearm, BodyPart::RightHand, false},
    {BodyPart::RightThigh, BodyPart::RightShin, true},
    {BodyPart::RightShin, BodyPart::RightFoot, false},
}};

void add_link(
    const SkeletonData& skeleton, std::size_t joint, std::size_t of, std::size_t end, float share,
    std::vector<TwistLink>& links) {
    const Vec3& bone = skeleton.rest.translations[end];
    if (glm::length(bone) > kShortestBone) {
        links.push_back(
            {static_cast<std::uint16_t>(joint), static_cast<std::uint16_t>(of),
             glm::normalize(bone), share});
    }
}

std::vector<TwistLink> find_body_twists(const SkeletonData& skeleton) {
    const BodyJoints body = find_body_joints(skeleton);
    std::vector<TwistLink> links;
    for (const LimbBone& bone : kLimbBones) {
        const std::size_t begin = body[bone.begin];
        const std::size_t end = body[bone.end];
        if (!body.has(bone.begin) || !body.has(bone.end)
            || skeleton.parents[end] != static_cast<std::int32_t>(begin)) {
            continue;
        }
        for (std::size_t joint = begin + 1; joint < skeleton.joints.size(); ++joint) {
            if (skeleton.parents[joint] == static_cast<std::int32_t>(begin)
                && is_called_twist(skeleton.joints[joint])) {
                const float place = place_on_bone(skeleton, joint, end);
                // Trunk, twist joint and arm: half of the twist at each seam.
                const float share = bone.own ? 0.5f * (place - 1) : place;
                add_link(skeleton, joint, bone.own ? begin : end, end, share, links);
            }
        }
    }
    return links;
}

/// The farthest child of `parent` besides `joint`: where its bone ends.
std::size_t bone_end(const SkeletonData& skeleton, std::int32_t parent, std::size_t joint) {
    std::size_t end = joint;
    float longest = -1;
    for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
        const float length = glm::length(skeleton.rest.translations[i]);
        if (skeleton.parents[i] == parent && i != joint && length > longest) {
            longest = length;
            end = i;
        }
    }
    return end;
}

}  // namespace

float twist_angle(const Quat& rotation, const Vec3& axis) {
    const float along = glm::dot(Vec3(rotation.x, rotation.y, rotation.z), axis);
    return rotation.w < 0 ? 2 * std::atan2(-along, -rotation.w) : 2 * std::atan2(along, rotation.w);
}

std::vector<TwistLink>
find_twist_links(const SkeletonData& skeleton, std::span<const TwistJoint> asked) {
    if (asked.empty()) {
        return find_body_twists(skeleton);
    }
    std::vector<TwistLink> links;
    for (const TwistJoint& twist : asked) {
        const std::size_t joint = find_skeleton_joint(skeleton, twist.joint);
        const std::size_t of = find_skeleton_joint(skeleton, twist.of);
        const std::size_t count = skeleton.joints.size();
        if (joint >= count || of >= count || of == joint || skeleton.parents[joint] < 0) {
            continue;
        }
        const std::int32_t parent = skeleton.parents[joint];
        if (skeleton.parents[of] == parent) {
            add_link(skeleton, joint, of, of, twist.share, links);
        } else if (static_cast<std::int32_t>(of) == parent) {
            add_link(skeleton, joint, of, bone_end(skeleton, parent, joint), twist.share, links);
        }
    }
    return links;
}

void apply_twist_joints(
    const SkeletonData& skeleton, std::span<const TwistLink> links, float weight, LocalPose& pose) {
    if (!(weight > 0)) {  // NaN: none
        return;
    }
    for (const TwistLink& link : links) {
        const Quat back = glm::conjugate(skeleton.rest.rotations[link.of]);
        const bool is_own = skeleton.parents[link.joint] == static_cast<std::int32_t>(link.of);
        const Quat turned =
            is_own ? back * pose.rotations[link.of] : pose.rotations[link.of] * back;
        const float angle = link.share * twist_angle(turned, link.axis);
        const Quat twisted = rotation_about(link.axis, angle) * skeleton.rest.rotations[link.joint];
        pose.rotations[link.joint] =
            slerp(pose.rotations[link.joint], twisted, std::min(weight, 1.0f));
    }
}

}  // namespace limn
