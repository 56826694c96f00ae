#include "systems/animation/pose_levels.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

// Techniques: engine.lod-mesh

namespace limn {
namespace {

void resize_joints(const SkeletonData& skeleton, std::size_t count, std::vector<Affine>& joints) {
    const std::size_t first = std::min(joints.size(), count);
    joints.resize(count);
    for (std::size_t j = first; j < count; ++j) {
        const LocalPose& rest = skeleton.rest;
        const Affine local = affine_from(rest.translations[j], rest.rotations[j], rest.scales[j]);
        const std::int32_t parent = skeleton.parents[j];
        joints[j] = parent < 0 ? local : joints[static_cast<std::size_t>(parent)] * local;
    }
}

}  // namespace

void resize_pose(const SkeletonData& skeleton, std::size_t joints, Pose& pose) {
    const std::size_t count = std::min(joints, skeleton.joints.size());
    resize_joints(skeleton, count, pose.joints);
    resize_joints(skeleton, count, pose.previous);
}

std::size_t needed_joints(const SkinWeights& weights, const SkinData& skin) {
    std::size_t needed = 0;
    const std::size_t used = std::min(used_joints(weights), skin.joints.size());
    for (const std::uint16_t joint : std::span(skin.joints).first(used)) {
        needed = std::max<std::size_t>(needed, joint + 1u);
    }
    return needed;
}

}  // namespace limn
