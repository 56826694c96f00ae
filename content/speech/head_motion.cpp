#include "content/speech/head_motion.h"

#include "ecs/base/hash.h"
#include "ecs/base/rng.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kNod = 3.0f;         ///< degrees
constexpr float kNodWidth = 0.16f;   ///< standard deviation [s]
constexpr float kSway = 2.0f;        ///< degrees, about each axis
constexpr float kSwayPeriod = 4.3f;  ///< [s]
constexpr float kFade = 0.5f;        ///< at the ends [s]

}  // namespace

Quat head_at(const SpeechTrack& track, float time, std::uint64_t seed) {
    const float from_ends = std::min(time, track.duration() - time);
    const float moving = glm::smoothstep(0.0f, kFade, from_ends);
    float nod = 0.0f;
    for (const SpeechSegment& segment : track.segments) {
        if (segment.sound.stressed) {
            const float offset = (time - 0.5f * (segment.start + segment.end)) / kNodWidth;
            nod = std::max(nod, kNod * std::exp(-0.5f * offset * offset));
        }
    }
    Random random(seed, 0, name_hash("head_at"), 0);
    Vec3 sway(0);
    for (int axis = 0; axis < 3; ++axis) {
        const float phase = random.uniform(0.0f, 2.0f * kPi);
        const float period = kSwayPeriod * random.uniform(0.8f, 1.25f);
        sway[axis] = kSway * std::sin(2.0f * kPi * time / period + phase);
    }
    const Vec3 angles = moving * (Vec3(nod, 0, 0) + sway);
    return Quat(Vec3(radians(angles.x), radians(angles.y), 0.5f * radians(angles.z)));
}

}  // namespace limn
