#include "systems/faces/wrinkle_track_system.h"

#include "ecs/base/math.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

// Techniques: wrinkle.maps.animation

namespace limn {

WrinkleWeights wrinkle_weights_at(const WrinkleTrack& track, double time) {
    const std::vector<WrinkleKey>& keys = track.keys;
    if (keys.size() < 2) {
        return keys.empty() ? WrinkleWeights{} : keys.front().weights;
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
    WrinkleWeights weights;
    for (float WrinkleWeights::*const region : kWrinkleRegions) {
        weights.*region = glm::mix(from->weights.*region, to->weights.*region, u);
    }
    return weights;
}

void update_wrinkle_tracks(
    Query<const WrinkleTrack, WrinkleWeights> tracks, Res<const FrameTime> time) {
    tracks.each([now = time->time](const WrinkleTrack& track, WrinkleWeights& weights) {
        if (!track.keys.empty()) {
            weights = wrinkle_weights_at(track, now);
        }
    });
}

}  // namespace limn
