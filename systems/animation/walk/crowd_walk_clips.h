#pragma once

#include "ecs/components/crowd_script.h"
#include "ecs/components/skeleton.h"
#include "ecs/entity.h"

#include <vector>

namespace limn {

/// Resource: clips of walks, by style, and of what people do besides; never saved.
struct CrowdWalkClips {
    struct Entry {
        SkeletonId skeleton{};
        Entity style{};
        ClipId clip{};
        float speed = 1.0f;  ///< at which its feet do not slide [m/s]
    };
    struct Activity {
        SkeletonId skeleton{};
        CrowdActivity activity = CrowdActivity::Stand;
        ClipId clip{};
    };
    std::vector<Entry> entries{};
    std::vector<Activity> activities{};

    [[nodiscard]] const Entry* find(SkeletonId skeleton, Entity style) const;
};

}  // namespace limn
