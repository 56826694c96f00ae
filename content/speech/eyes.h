#pragma once

#include <cstdint>
#include <vector>

namespace limn {

// Blinks and gaze of a speaker who faces the viewer. Blinks: 26 per minute at log-normal intervals
// (A. Bentivoglio et al., 1997). Gaze: 3.1 s at the viewer, 0.9 s away (S. Lee, J. Badler and N.
// Badler, "Eyes Alive", 2002), with saccades that take 21 ms + 2.2 ms per degree (A. Bahill et al.,
// 1975).

struct EyePose {
    float closed = 0.0f;  ///< 0: open, 1: lids shut
    float yaw = 0.0f;     ///< of the gaze [degrees], > 0: to the speaker's left
    float pitch = 0.0f;   ///< [degrees], > 0: up
};

struct Blink {
    float start = 0.0f;    ///< [s]
    float closing = 0.0f;  ///< duration [s]
    float shut = 0.0f;     ///< [s]
    float opening = 0.0f;  ///< [s]
};

/// A saccade that begins at `start` and ends at these angles.
struct GazeShift {
    float start = 0.0f;     ///< [s]
    float duration = 0.0f;  ///< [s]
    float yaw = 0.0f;       ///< [degrees]
    float pitch = 0.0f;     ///< [degrees]
};

struct EyeTrack {
    std::vector<Blink> blinks;      ///< one after the other
    std::vector<GazeShift> shifts;  ///< one after the other; the gaze starts straight ahead
};

/// A track of `duration` [s], determined by `seed`. It ends with open eyes that look ahead.
[[nodiscard]] EyeTrack make_eye_track(float duration, std::uint64_t seed);

[[nodiscard]] EyePose eyes_at(const EyeTrack& track, float time);

/// Duration of a saccade of this size [s].
[[nodiscard]] float saccade_duration(float degrees);

}  // namespace limn
