#include "ecs/components/surface_anchors.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

constexpr float kBendWeights = 12.0f / 27.0f;  ///< largest sum of the weights: 12 u v w

}  // namespace

float max_motion(std::span<const Vec4> rest, std::span<const Vec4> patches, float largest_offset) {
    float most = 0.0f;
    for (std::size_t f = 0; f + kPatchTexels <= std::min(rest.size(), patches.size());
         f += kPatchTexels) {
        float points = 0.0f;
        float bends = 0.0f;
        float normals = 0.0f;
        for (std::size_t i = 0; i < kPatchTexels; ++i) {
            const float moved = glm::distance(Vec3(rest[f + i]), Vec3(patches[f + i]));
            float& farthest = i < kPatchPoints ? points : i < kPatchNormals ? bends : normals;
            farthest = std::max(farthest, moved);
        }
        const bool turns = points > 0.0f || bends > 0.0f || normals > 0.0f;
        const float surface = points + kBendWeights * bends;
        most = std::max(most, surface + (turns ? 2.0f * largest_offset : 0.0f));
    }
    return most;
}

}  // namespace limn
