#include "content/bake/motion/body_frame.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {
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
