#include "ecs/components/surface_anchors.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {

float max_motion(std::span<const Vec4> rest, std::span<const Vec4> patches, float largest_offset) {
    float most = 0.0f;
    for (std::size_t f = 0; f + kPatchTexels <= std::min(rest.size(), patches.size());
         f += kPatchTexels) {
        float farthest = 0.0f;
        bool turns = false;
        for (std::size_t i = 0; i < kPatchTexels; ++i) {
            const float moved = glm::distance(Vec3(rest[f + i]), Vec3(patches[f + i]));
            turns = turns || moved > 0.0f;
            farthest = i < kPatchPoints ? std::max(farthest, moved) : farthest;
        }
        most = std::max(most, farthest + (turns ? 2.0f * largest_offset : 0.0f));
    }
    return most;
}

}  // namespace limn
