#include "content/make/models/merge_joints.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

// Techniques: engine.lod-mesh

namespace limn {
namespace {

/// For each joint of the skin, the one that moves its vertices.
std::vector<std::uint16_t>
find_heirs(const SkinData& skin, const SkeletonData& skeleton, std::size_t joints) {
    std::vector<std::uint16_t> heirs;
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        std::int32_t joint = skin.joints[i];
        auto found = skin.joints.begin() + static_cast<std::ptrdiff_t>(i);
        while (joint >= 0 && static_cast<std::size_t>(joint) >= joints) {
            joint = skeleton.parents[static_cast<std::size_t>(joint)];
            const auto heir = std::ranges::find(skin.joints, joint);
            found = heir != skin.joints.end() ? heir : found;
        }
        heirs.push_back(static_cast<std::uint16_t>(found - skin.joints.begin()));
    }
    return heirs;
}

}  // namespace

void merge_joints(
    SkinWeights& weights, const SkinData& skin, const SkeletonData& skeleton, std::size_t joints) {
    const std::vector<std::uint16_t> heirs = find_heirs(skin, skeleton, joints);
    SkinWeights merged;
    for (std::size_t v = 0; v + 1 < weights.first.size(); ++v) {
        const auto first = static_cast<std::ptrdiff_t>(merged.joints.size());
        merged.first.push_back(static_cast<std::uint32_t>(first));
        for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i) {
            const std::uint16_t heir = heirs[weights.joints[i]];
            const auto same = std::find(merged.joints.begin() + first, merged.joints.end(), heir);
            if (same != merged.joints.end()) {
                merged.weights[static_cast<std::size_t>(same - merged.joints.begin())] +=
                    weights.weights[i];
            } else {
                merged.joints.push_back(heir);
                merged.weights.push_back(weights.weights[i]);
            }
        }
    }
    merged.first.push_back(static_cast<std::uint32_t>(merged.joints.size()));
    weights = std::move(merged);
}

}  // namespace limn
