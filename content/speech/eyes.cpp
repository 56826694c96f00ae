#include "content/speech/eyes.h"

#include "ecs/base/hash.h"
#include "ecs/base/math.h"
#include "ecs/base/rng.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr float kBlinkInterval = 60.0f / 26.0f;  ///< mean [s]
constexpr float kBlinkSpread = 0.5f;             ///< standard deviation of the logarithm
constexpr float kAtViewer = 3.1f;                ///< mean [s]
constexpr float kAway = 0.9f;                    ///< mean [s]
constexpr float kMeanSaccade = 8.0f;             ///< [degrees]; 85 % are below 15
constexpr float kLargestSaccade = 25.0f;         ///< [degrees]

float exponential(Random& random, float mean) {
    return -mean * std::log(1.0f - random.uniform(0.0f, 0.999f));
}

/// Mean 1.
float log_normal(Random& random) {
    return std::exp(kBlinkSpread * random.normal() - 0.5f * kBlinkSpread * kBlinkSpread);
}

float length_of(const Blink& blink) {
    return blink.closing + blink.shut + blink.opening;
}

}  // namespace

float saccade_duration(float degrees) {
    return 0.021f + 0.0022f * std::abs(degrees);
}

EyeTrack make_eye_track(float duration, std::uint64_t seed) {
    EyeTrack track;
    Random random(seed, 0, name_hash("make_eye_track"), 0);
    for (float time = kBlinkInterval * log_normal(random);;) {
        const Blink blink{
            .start = time,
            .closing = random.uniform(0.075f, 0.1f),
            .shut = random.uniform(0.02f, 0.05f),
            .opening = random.uniform(0.15f, 0.25f)};
        if (time + length_of(blink) > duration) {
            break;
        }
        track.blinks.push_back(blink);
        time += length_of(blink) + kBlinkInterval * log_normal(random);
    }
    for (float time = exponential(random, kAtViewer);;) {
        const float angle = std::min(exponential(random, kMeanSaccade), kLargestSaccade);
        const float direction = random.uniform(0.0f, 2.0f * kPi);
        const float saccade = saccade_duration(angle);
        const float away = std::max(exponential(random, kAway), saccade);
        if (time + away + saccade > duration) {
            break;
        }
        track.shifts.push_back(
            {time, saccade, angle * std::cos(direction), 0.5f * angle * std::sin(direction)});
        track.shifts.push_back({time + away, saccade, 0.0f, 0.0f});
        time += away + saccade + exponential(random, kAtViewer);
    }
    return track;
}

EyePose eyes_at(const EyeTrack& track, float time) {
    EyePose pose;
    for (const Blink& blink : track.blinks) {
        const float since = time - blink.start;
        const float closing = glm::smoothstep(0.0f, blink.closing, since);
        const float opening = glm::smoothstep(blink.closing + blink.shut, length_of(blink), since);
        pose.closed = std::max(pose.closed, closing - opening);
    }
    for (const GazeShift& shift : track.shifts) {
        const float done = glm::smoothstep(0.0f, shift.duration, time - shift.start);
        pose.yaw += done * (shift.yaw - pose.yaw);
        pose.pitch += done * (shift.pitch - pose.pitch);
    }
    return pose;
}

}  // namespace limn
