#include "systems/faces/wrinkle_track_system.h"

#include "ecs/base/math.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

// Techniques: wrinkle.maps.animation

namespace limn {
namespace {

using RegionWeights = std::array<float, kWrinkleRegions.size()>;

/// Without a preset.
WrinkleWeights plain(const RegionWeights& regions) {
    WrinkleWeights weights;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        weights.*kWrinkleRegions[i] = regions[i];
    }
    return weights;
}

}  // namespace

WrinkleWeights wrinkle_weights_at(const WrinkleTrack& track, double time) {
    const std::vector<WrinkleKey>& keys = track.keys;
    if (keys.size() < 2) {
        return keys.empty() ? WrinkleWeights{} : plain(region_weights(keys.front().weights));
    }
    const double begin = keys.front().time;
    const double duration = keys.back().time - begin;
    double t = time - begin;
    if (track.loop && duration > 0) {
        t -= std::floor(t / duration) * duration;
    }
    const auto now = static_cast<float>(begin + std::clamp(t, 0.0, std::max(duration, 0.0)));
    const auto to = std::upper_bound(
        keys.begin() + 1, keys.end() - 1, now,
        [](float at, const WrinkleKey& key) { return at < key.time; });
    const auto from = to - 1;
    const float step = to->time - from->time;
    float u = step > 0 ? std::clamp((now - from->time) / step, 0.0f, 1.0f) : 1.0f;
    u = track.smooth ? u * u * (3 - 2 * u) : u;
    RegionWeights weights = region_weights(from->weights);
    const RegionWeights next = region_weights(to->weights);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        weights[i] = glm::mix(weights[i], next[i], u);
    }
    return plain(weights);
}

void update_wrinkle_tracks(
    Query<const WrinkleTrack, WrinkleWeights> tracks, Res<const FrameTime> time) {
    tracks.each([now = time->time](const WrinkleTrack& track, WrinkleWeights& weights) {
        if (!track.keys.empty()) {
            weights = wrinkle_weights_at(track, now);
        }
    });
}

void update_wrinkle_channels(
    Query<const MeshInstance, const Deformed, WrinkleWeights> faces,
    Query<const MorphWeights> morphs, Res<const Assets> assets) {
    faces.each([&](Entity, const MeshInstance& instance, const Deformed& deformed,
                   WrinkleWeights& weights) {
        const auto* const set = morphs.find<const MorphWeights>(deformed.character);
        if (set == nullptr || instance.mesh.index >= assets->meshes.size()) {
            return;
        }
        const std::vector<MorphTarget>& shapes = assets->meshes[instance.mesh.index].morphs;
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            const std::size_t at = deformed.first_morph + i;
            const auto channel = std::ranges::find(kWrinkleChannels, shapes[i].name);
            if (channel != kWrinkleChannels.end() && at < set->weights.size()) {
                const auto region = static_cast<std::size_t>(channel - kWrinkleChannels.begin());
                weights.*kWrinkleRegions[region] = set->weights[at];
            }
        }
    });
}

}  // namespace limn
