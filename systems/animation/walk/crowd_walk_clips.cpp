#include "systems/animation/walk/crowd_walk_clips.h"

#include <algorithm>

// Techniques: char.crowd-script

namespace limn {

const CrowdWalkClips::Entry* CrowdWalkClips::find(SkeletonId skeleton, Entity style) const {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& entry) {
        return entry.skeleton == skeleton && entry.style == style;
    });
    return found != entries.end() ? &*found : nullptr;
}

}  // namespace limn
