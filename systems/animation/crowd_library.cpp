#include "systems/animation/crowd_library.h"

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

bool is_pose_due(const CrowdPoseState& state, Entity entity, std::uint64_t frame) {
    const std::uint64_t turn = frame + entity.index / kNeighbors;
    return state.interval < 2 || turn % state.interval == 0;
}

}  // namespace limn
