#include "content/bake/motion/body_frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
namespace {

/// The joint and its ancestors, up to the first one.
std::vector<std::uint16_t> list_ancestors(const SkeletonData& skeleton, std::uint16_t joint) {
    std::vector<std::uint16_t> ancestors;
    for (std::int32_t j = joint; j >= 0; j = skeleton.parents[static_cast<std::size_t>(j)]) {
        ancestors.push_back(static_cast<std::uint16_t>(j));
    }
    return ancestors;
}

}  // namespace

std::vector<Affine> find_rest_matrices(const SkeletonData& skeleton) {
    return find_frame_joints(
        skeleton,
        {1, skeleton.joints.size(), skeleton.rest.translations, skeleton.rest.rotations,
         skeleton.rest.scales},
        0);
}

float find_leg_length(const SkeletonData& skeleton, const BodyJoints& body) {
    const std::vector<Affine> rest = find_rest_matrices(skeleton);
    const auto distance = [&](BodyPart a, BodyPart b) {
        return glm::distance(
            transform_point(rest[body[a]], Vec3(0)), transform_point(rest[body[b]], Vec3(0)));
    };
    float sum = 0;
    float legs = 0;
    for (const auto& [thigh, shin, foot] :
         {std::array{BodyPart::LeftThigh, BodyPart::LeftShin, BodyPart::LeftFoot},
          std::array{BodyPart::RightThigh, BodyPart::RightShin, BodyPart::RightFoot}}) {
        if (body.has(thigh) && body.has(shin) && body.has(foot)) {
            sum += distance(thigh, shin) + distance(shin, foot);
            legs += 1;
        }
    }
    return legs > 0 ? sum / legs : 0.0f;
}

std::vector<std::uint16_t> find_foot_joints(const BodyJoints& body) {
    std::vector<std::uint16_t> joints;
    for (const BodyPart part :
         {BodyPart::LeftFoot, BodyPart::LeftToes, BodyPart::RightFoot, BodyPart::RightToes}) {
        if (body.has(part)) {
            joints.push_back(body[part]);
        }
    }
    return joints;
}

std::uint16_t find_body_root(const SkeletonData& skeleton, const BodyJoints& body) {
    std::vector<std::uint16_t> common;
    for (const BodyPart part :
         {BodyPart::LeftThigh, BodyPart::RightThigh,
          body.has(BodyPart::Chest) ? BodyPart::Chest : BodyPart::Head}) {
        if (!body.has(part)) {
            return body.has(BodyPart::Hips) ? body[BodyPart::Hips] : std::uint16_t{0};
        }
        const std::vector<std::uint16_t> ancestors = list_ancestors(skeleton, body[part]);
        if (common.empty()) {
            common = ancestors;
        }
        std::erase_if(common, [&](std::uint16_t joint) {
            return std::find(ancestors.begin(), ancestors.end(), joint) == ancestors.end();
        });
    }
    return common.front();
}

void move_joint(
    const SkeletonData& skeleton, MotionFrames& frames, std::size_t frame, std::uint16_t joint,
    const Vec3& offset) {
    const std::int32_t parent = skeleton.parents[joint];
    Vec3 local = offset;
    if (parent >= 0) {
        const Affine outer =
            find_frame_joints(skeleton, frames, frame)[static_cast<std::size_t>(parent)];
        local = transform_vector(to_affine(glm::inverse(to_mat4(outer))), offset);
    }
    frames.translations[frame * frames.joints + joint] += local;
}

float add_travel(const SkeletonData& skeleton, MotionFrames& frames) {
    const BodyJoints body = find_body_joints(skeleton);
    const std::vector<std::uint16_t> feet = find_foot_joints(body);
    if (feet.empty()) {
        return 0;
    }
    std::vector<std::vector<Vec3>> paths;
    for (const std::uint16_t foot : feet) {
        paths.push_back(joint_path(skeleton, frames, foot));
    }
    const std::uint16_t root = find_body_root(skeleton, body);
    Vec3 moved(0);
    for (std::size_t f = 1; f < frames.frames(); ++f) {
        const auto lowest =
            std::min_element(paths.begin(), paths.end(), [f](const auto& a, const auto& b) {
                return a[f].y + a[f - 1].y < b[f].y + b[f - 1].y;
            });
        const Vec3 step = (*lowest)[f - 1] - (*lowest)[f];
        moved += Vec3(step.x, 0, step.z);
        move_joint(skeleton, frames, f, root, moved);
    }
    return glm::length(moved);
}

}  // namespace limn
