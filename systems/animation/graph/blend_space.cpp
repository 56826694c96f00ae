#include "systems/animation/graph/blend_space.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.motion-select

namespace limn {

namespace {

ClipWeights weights_on_line(std::span<const GraphClip> clips, float x) {
    // The nearest clips on both sides; either may be missing.
    const GraphClip* below = nullptr;
    const GraphClip* above = nullptr;
    for (const GraphClip& clip : clips) {
        if (clip.at.x <= x && (below == nullptr || clip.at.x > below->at.x)) {
            below = &clip;
        }
        if (clip.at.x >= x && (above == nullptr || clip.at.x < above->at.x)) {
            above = &clip;
        }
    }
    ClipWeights weights{};
    const auto weight = [&](const GraphClip* clip) -> float& {
        return weights[static_cast<std::size_t>(clip - clips.data())];
    };
    if (below == nullptr || above == nullptr || below->at.x == above->at.x) {
        weight(below != nullptr ? below : above) = 1.0f;
        return weights;
    }
    const float u = (x - below->at.x) / (above->at.x - below->at.x);
    weight(below) = 1.0f - u;
    weight(above) = u;
    return weights;
}

ClipWeights weights_in_plane(std::span<const GraphClip> clips, const Vec2& point) {
    ClipWeights weights{};
    float sum = 0.0f;
    for (std::size_t i = 0; i < clips.size(); ++i) {
        float influence = 1.0f;
        for (const GraphClip& other : clips) {
            const Vec2 band = other.at - clips[i].at;
            const float length2 = glm::dot(band, band);
            if (length2 > 1e-12f) {
                const float along = glm::dot(point - clips[i].at, band) / length2;
                influence = std::min(influence, 1.0f - along);
            }
        }
        weights[i] = std::max(influence, 0.0f);
        sum += weights[i];
    }
    for (float& weight : weights) {
        weight /= sum;
    }
    return weights;
}

}  // namespace

ClipWeights blend_weights(std::span<const GraphClip> clips, bool is_plane, const Vec2& point) {
    clips = clips.first(std::min(clips.size(), kMaxGraphClips));
    const Vec2 p(std::isfinite(point.x) ? point.x : 0.0f, std::isfinite(point.y) ? point.y : 0.0f);
    if (clips.size() < 2) {
        return {1.0f};
    }
    return is_plane ? weights_in_plane(clips, p) : weights_on_line(clips, p.x);
}

ClipWeights blend_weights(const GraphState& state, const MotionGraph& graph) {
    return blend_weights(
        state.clips, state.y != GraphParameter::None,
        {parameter_of(graph, state.x), parameter_of(graph, state.y)});
}

std::size_t heaviest(const ClipWeights& weights) {
    return static_cast<std::size_t>(
        std::max_element(weights.begin(), weights.end()) - weights.begin());
}

}  // namespace limn
