#pragma once

#include "ecs/components/crowd_pose.h"
#include "ecs/components/skeleton.h"
#include "ecs/entity.h"
#include "systems/animation/crowd_clip.h"
#include "systems/animation/pose_chain.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace limn {

/// Resource: what was made of skeletons and clips. Empty entries: of no crowd, or not convertible.
struct CrowdLibrary {
    struct Entry {
        SkeletonId skeleton;
        std::shared_ptr<const CrowdClip> clip;  ///< null: cannot be compressed
    };
    /// How many joints a mesh needs with a skin.
    struct Need {
        std::uint32_t version = 0;  ///< of the mesh
        SkinId skin;
        std::uint32_t joints = 0;
    };
    std::vector<std::vector<std::shared_ptr<const CrowdRig>>> rigs;  ///< by skeleton: its levels
    std::vector<std::vector<Entry>> clips;                           ///< by clip
    std::vector<Need> needs;                                         ///< by mesh

    [[nodiscard]] const Entry* find(SkeletonId skeleton, ClipId clip) const;
    /// Of the first `joints` of the skeleton; null: none was made.
    [[nodiscard]] const CrowdRig* find_rig(SkeletonId skeleton, std::size_t joints) const;
};

/// How many of the skeleton's first joints a character needs. `state`: null for all.
[[nodiscard]] std::size_t posed_joints(const CrowdPoseState* state, const SkeletonData& skeleton);

/// Whether a character is posed in this step. 16 neighbors are posed in the same step, and the
/// next 16 in another one: groups stay whole, and each step has as much work as any other.
[[nodiscard]] bool is_pose_due(const CrowdPoseState& state, Entity entity, std::uint64_t frame);

}  // namespace limn
