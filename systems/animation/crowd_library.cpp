#include "systems/animation/crowd_library.h"

#include <algorithm>

namespace limn {
namespace {

constexpr std::uint32_t kNeighbors = 16;  ///< of consecutive entity indices

}  // namespace

const CrowdLibrary::Entry* CrowdLibrary::find(SkeletonId skeleton, ClipId clip) const {
    if (clip.index < clips.size()) {
        for (const Entry& entry : clips[clip.index]) {
            if (entry.skeleton == skeleton) {
                return &entry;
            }
        }
    }
    return nullptr;
}

const CrowdRig* CrowdLibrary::find_rig(SkeletonId skeleton, std::size_t joints) const {
    if (skeleton.index < rigs.size()) {
        for (const std::shared_ptr<const CrowdRig>& rig : rigs[skeleton.index]) {
            if (rig->joints() == joints) {
                return rig.get();
            }
        }
    }
    return nullptr;
}

std::size_t posed_joints(const CrowdPoseState* state, const SkeletonData& skeleton) {
    const std::size_t all = skeleton.joints.size();
    return state != nullptr && state->joints > 0 ? std::min<std::size_t>(state->joints, all) : all;
}

bool is_pose_due(const CrowdPoseState& state, Entity entity, std::uint64_t frame) {
    const std::uint64_t turn = frame + entity.index / kNeighbors;
    return state.interval < 2 || turn % state.interval == 0;
}

}  // namespace limn
