#pragma once

#include "ecs/base/math.h"
#include "ecs/reflect.h"

#include <vector>

namespace limn {

/// How rotations between keys are found.
enum class RotationMethod : std::uint8_t {
    Slerp,  ///< along the great arc at constant speed, with a corner at each key (anim.slerp)
    Nlerp,  ///< straight, then normalized: slow at both keys (anim.quat-lerp)
    Squad,  ///< spherical quadrangle spline, smooth at the keys (anim.squad)
    Euler,  ///< yaw, pitch and roll each by itself (anim.euler)
};

/// When keys are reached.
enum class RotationTiming : std::uint8_t {
    Keys,       ///< at their own times
    EvenSpeed,  ///< so that the angular speed is constant
};

struct RotationKey {
    float time = 0.0f;
    Quat rotation = {1, 0, 0, 0};
};

LIMN_FIELDS(RotationKey) {
    LIMN_FIELD(time, "since the start of the level; greater than the previous key's", "s", 0, 1e6);
    LIMN_FIELD(rotation, "x y z w, or [yaw, pitch, roll] in degrees");
}

/// Rotates its entity from key to key, always along the shorter arc (anim.shortest-arc). After the
/// last key it stays there or starts over.
struct RotationTrack {
    std::vector<RotationKey> keys;
    RotationMethod method = RotationMethod::Slerp;
    RotationTiming timing = RotationTiming::Keys;
    bool loop = false;
};

LIMN_FIELDS(RotationTrack) {
    LIMN_FIELD(keys, "keyframes, in order of time");
    LIMN_FIELD(
        method, .doc = "how rotations between keys are found", .values = "slerp nlerp squad euler");
    LIMN_FIELD(
        timing, .doc = "keys at their own times, or reached at an even angular speed",
        .values = "keys even_speed");
    LIMN_FIELD(loop, "starts over after the last key");
}

/// A track made ready to be evaluated.
struct RotationTrackState {
    std::vector<float> times;     ///< [s], increasing
    std::vector<Quat> rotations;  ///< aligned: each is nearest to the one before
    std::vector<Quat> inner;      ///< control points of squad
};

}  // namespace limn
