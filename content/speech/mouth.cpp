#include "content/speech/mouth.h"

#include "ecs/base/math.h"

#include <algorithm>

// Techniques: face.dominance, face.viseme

namespace limn {

namespace {

/// Targets and strengths of one viseme, by axis.
struct VisemeMouth {
    MouthPose target;
    MouthPose strength;
};

// Consonants leave axes that they do not need to their neighbors: for example width in t, k and n.
constexpr std::array<VisemeMouth, kVisemes> kMouths{{
    {{0.0f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.6f, 0.3f, 0.3f, 0.5f, 0.5f}},     // silence, h
    {{0.05f, 0.0f, 0.1f, 1.0f, 0.0f}, {0.9f, 0.15f, 0.15f, 1.0f, 0.8f}},  // p b m
    {{0.1f, 0.1f, 0.0f, 0.0f, 1.0f}, {0.8f, 0.2f, 0.2f, 0.8f, 1.0f}},     // f v
    {{0.2f, 0.1f, 0.0f, 0.0f, 0.0f}, {0.5f, 0.2f, 0.2f, 0.5f, 0.5f}},     // th
    {{0.2f, 0.1f, 0.0f, 0.0f, 0.0f}, {0.4f, 0.15f, 0.15f, 0.5f, 0.5f}},   // t d
    {{0.3f, 0.0f, 0.0f, 0.0f, 0.0f}, {0.3f, 0.1f, 0.15f, 0.5f, 0.5f}},    // k g
    {{0.15f, -0.4f, 0.6f, 0.0f, 0.0f}, {0.7f, 0.6f, 0.9f, 0.5f, 0.5f}},   // ch j sh
    {{0.08f, 0.3f, 0.0f, 0.0f, 0.0f}, {0.8f, 0.3f, 0.2f, 0.5f, 0.5f}},    // s z
    {{0.25f, 0.1f, 0.0f, 0.0f, 0.0f}, {0.3f, 0.15f, 0.15f, 0.5f, 0.5f}},  // n l
    {{0.2f, -0.3f, 0.4f, 0.0f, 0.0f}, {0.4f, 0.5f, 0.6f, 0.5f, 0.5f}},    // r
    {{1.0f, 0.1f, 0.0f, 0.0f, 0.0f}, {0.7f, 0.4f, 0.5f, 0.5f, 0.5f}},     // a
    {{0.5f, 0.5f, 0.0f, 0.0f, 0.0f}, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f}},     // e
    {{0.25f, 0.8f, 0.0f, 0.0f, 0.0f}, {0.6f, 0.7f, 0.5f, 0.5f, 0.5f}},    // i
    {{0.55f, -0.5f, 0.7f, 0.0f, 0.0f}, {0.6f, 0.8f, 0.9f, 0.5f, 0.5f}},   // o
    {{0.25f, -0.8f, 1.0f, 0.0f, 0.0f}, {0.6f, 0.9f, 1.0f, 0.5f, 0.5f}},   // u
}};

// Decay of dominance [1/s]. Lips are rounded 100 to 200 ms before the sound that needs it.
constexpr MouthPose kBefore{14.0f, 8.0f, 6.0f, 30.0f, 25.0f};
constexpr MouthPose kAfter{14.0f, 12.0f, 12.0f, 30.0f, 25.0f};

}  // namespace

const MouthPose& mouth_of(Viseme viseme) {
    return kMouths[static_cast<std::size_t>(viseme)].target;
}

MouthTrack make_mouth_track(const SpeechTrack& track) {
    MouthTrack targets;
    for (std::size_t i = 0; i < track.segments.size(); ++i) {
        const SpeechSegment& segment = track.segments[i];
        const VisemeMouth& mouth = kMouths[static_cast<std::size_t>(viseme_of(segment))];
        const bool is_margin = i == 0 || i + 1 == track.segments.size();
        for (std::size_t axis = 0; axis < kMouthAxes; ++axis) {
            const float center = i == 0      ? segment.start
                                 : is_margin ? segment.end
                                             : 0.5f * (segment.start + segment.end);
            targets[axis].push_back(
                {.center = center,
                 .target = mouth.target[axis],
                 .strength = is_margin ? 1.0f : mouth.strength[axis],
                 .before = kBefore[axis],
                 .after = kAfter[axis]});
        }
    }
    return targets;
}

MouthPose mouth_at(const MouthTrack& track, float time) {
    MouthPose pose{};
    if (track[0].empty()) {
        return pose;
    }
    const float from_ends = std::min(time - track[0].front().center, track[0].back().center - time);
    const float speaking = glm::smoothstep(0.0f, kSpeechMargin, from_ends);
    for (std::size_t axis = 0; axis < kMouthAxes; ++axis) {
        pose[axis] = speaking * blend_targets(track[axis], time);
    }
    return pose;
}

}  // namespace limn
