#include "ecs/components/body_measures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <utility>

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
    const LocalPose& rest = skeleton.rest;
    std::vector<Affine> joints;
    joints.reserve(rest.size());
    for (std::size_t j = 0; j < rest.size(); ++j) {
        const Affine local = affine_from(rest.translations[j], rest.rotations[j], rest.scales[j]);
        const std::int32_t parent = skeleton.parents[j];
        joints.push_back(parent < 0 ? local : joints[static_cast<std::size_t>(parent)] * local);
    }
    return joints;
}

std::vector<Quat> find_frame_rotations(const SkeletonData& skeleton, std::span<const Quat> local) {
    std::vector<Quat> rotations;
    rotations.reserve(local.size());
    for (std::size_t j = 0; j < local.size(); ++j) {
        const std::int32_t parent = skeleton.parents[j];
        rotations.push_back(
            parent < 0 ? local[j] : rotations[static_cast<std::size_t>(parent)] * local[j]);
    }
    return rotations;
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

Vec3 find_left(const SkeletonData& skeleton, const BodyJoints& body) {
    const std::vector<Affine> rest = find_rest_matrices(skeleton);
    for (const auto& [left, right] :
         {std::pair{BodyPart::LeftThigh, BodyPart::RightThigh},
          std::pair{BodyPart::LeftUpperArm, BodyPart::RightUpperArm}}) {
        if (body.has(left) && body.has(right)) {
            const Vec3 across = transform_point(rest[body[left]], Vec3(0))
                                - transform_point(rest[body[right]], Vec3(0));
            return normalize_or(Vec3(across.x, 0, across.z), Vec3(1, 0, 0));
        }
    }
    return {1, 0, 0};
}

}  // namespace limn
